// What a loop need not do in every turn.
#pragma once

#include "vm/native/facts.h"

namespace vm::native {

// Does it do nothing but give a value, always the same, or leave by its exit?
bool is_operation(const Node& node);

// Can it be done in front of a loop, whether a turn does it or not?
bool is_movable(const Node& node);

// Puts a block in front of every loop head. All ways in lead through it, that of a resumed
// execution too, so what it computes holds in the whole loop.
void insert_preheaders(Function& function);

// After insert_preheaders(), of loops that facts have as walked: pointers become distances from the
// first byte of their variable, which is looked for once, in front of the loop. There is asked,
// too, that it holds none of the variables that the loop names. False: some loop's pointers go
// other ways; it has been added to `unwalked`, and the Function is to be made again.
bool walk_pointers(Function& function, const Facts& facts, std::vector<uint32_t>& unwalked);

// After insert_preheaders(): what a dominating block computes or checks is not done again.
void number_again(Function& function);

// Blocks that every whole turn goes through, from the head on.
std::vector<Block> every_turn(const Function& function, const Loop& loop);

// Makes selections of branches around a few cheap operations.
void choose(Function& function);

// Drops checks that the ranges of values prove: constants, masks, counted loops.
void drop_proven_checks(Function& function);

// Moves what does not change in a loop in front of it. A check that fails there leaves to the
// interpreter at the loop's head, which finds out what is wrong, and when.
void hoist(Function& function);

// After hoist(): constants of addresses into displacements, and what does not change of a sum that
// an access in a loop has for its address in front of it.
void split_addresses(Function& function);

// Addresses that nothing but exits wants are made there. True: there were some.
bool sink_addresses(Function& function);

}  // namespace vm::native
