// Pointers that walk: what a loop follows is a pointer from before it, or one that each turn moves.
// Such a pointer stays in its variable, or the loop is left; so the variable is looked for once,
// and the pointer is a distance from its first byte, which is compared with its size
// (docs/adr/0048-pointers-that-walk.md). Of one loop: found in walk_find.cc, changed in walk.cc,
// and what is left of it behind and in exits in walk_behind.cc.
#pragma once

#include "vm/native/loops.h"

namespace vm::native {

// A limit AND this is the limit: all limits are smaller. So is_far_from_the_ends() knows that
// (counted.h).
inline constexpr uint64_t kSmall = (uint64_t{1} << 61) - 1;

// The value that stands for a handle of the loop [head, last] outside of it.
struct Renamed {
  Val to = kNone;
  Block head = 0;
  Block last = 0;
};
using Renames = ByKey<Renamed>;

// The ways that lead to a block: from where, and by which of its targets.
using Ways = std::vector<std::vector<std::pair<Block, uint32_t>>>;

class Walk {
 public:
  Walk(Function& f, const Facts& facts, const Ways& ways, uint32_t loop)
      : f_(f),
        facts_(facts),
        ways_(ways),
        number_(loop),
        loop_(f.loops[loop]),
        front_(loop_.head - 1) {}

  // Does each pointer that the loop follows come from before it, or is it one that the loop moves?
  bool find();

  // After find(). `uses`: how often each value is used. `renames` gets what is to be renamed.
  void change(const std::vector<uint32_t>& uses, Constants& constants, Renames& renames);

 private:
  struct Walker {
    Val handle = kNone;      // in the loop
    uint32_t param = kNone;  // of the head; kNone: it stays what it is
    uint8_t site = 0;
    Val first = kNone;  // data address of the variable
    Val place = kNone;  // the same, of the machine
    Val size = kNone;
    Val distance = kNone;  // where the loop begins
    Val begin = kNone;     // ... and the place that the handle names there
    Val named = kNone;     // what distances add to for comparisons of places
    std::vector<std::pair<uint64_t, Val>> limits;  // size less so many bytes, at least 0
  };
  // A stretch of variables that the loop names.
  struct Question {
    MemBase base = MemBase::kSelf;
    uint64_t begin = 0;
    uint64_t end = 0;
  };

  bool is_inside(Val v) const { return !f_.values[v].constant && f_.values[v].block >= loop_.head; }

  template <class Visit>
  void each_turn(Visit visit) {
    for (Block b = loop_.head; b <= loop_.last; ++b) {
      End& end = f_.blocks[b].end;
      if (end.kind == EndKind::kLoop && end.target[0] == loop_.head) visit(end);
    }
  }

  uint32_t walker_of(Val v);

  uint32_t find_walker(Val v);

  static uint32_t same(uint32_t a, uint32_t b) { return a == b ? a : kNone; }

  uint32_t walker_of_all_ways(Block block, uint32_t param);

  uint32_t add_walker(Val handle, uint32_t param);

  // Loads may see what a register has instead of memory; stores may change whatever the loop names.
  void find_questions();

  // One with those that it touches.
  void add_question(Question q);

  // Is an address wanted by anything but loads?
  bool stores() const;

  Val constant(uint64_t bits, uint8_t width) { return constants_->of(bits, width); }
  uint32_t made(Node n, Block b);
  Val in_front(Op op, uint8_t width, Val a, Val b = kNone);
  Val in_front(const Node& n);
  Val part(Val reach, const Walker& w, size_t member, uint8_t width);

  void begin(Walker& w);

  // Leaves when the pointer's variable and this stretch have bytes in common.
  void ask(const Question& q, const Walker& w);

  // The parameter is a distance. What still wants the handle gets it at the block's beginning.
  Val new_param(Block b, uint32_t param);

  uint32_t handle_at(Val handle, Val distance, Block b);

  void lies_at(Val handle, Val distance);

  // Null: the value is no pointer that walks.
  const Walker* walker(Val v) const;

  void block(Block b);

  // All ways to a block that is no head come from blocks before it, so the arguments have their
  // distances already.
  void params(Block b);

  Val append(Op op, uint8_t width, Val a, Val b, Block block);
  void leave_if(Cond cond, Val a, Val b, uint32_t exit);

  void node(uint32_t number, Block b);

  // A distance from here on does not leave so many bytes more behind it.
  Val limit_of(uint32_t walker, uint64_t more);

  void resolve(uint32_t number, Block b);

  // Have so many bytes behind the distance been asked for already?
  bool is_covered(Val distance, int64_t bytes, Block b) const;
  void cover(Val distance, uint64_t bytes, Block b);

  // p[i]: a handle that is resolved at once and wanted by nothing else needs no question of its
  // own. Where the RESOLVE finds no bytes, the interpreter moves the handle, too.
  void find_steps(const std::vector<uint32_t>& uses);

  void move(uint32_t number, Block b);

  void select(uint32_t number, Block b);

  // WHILE p < stop: where the head asks whether a pointer is in front of another one, it asks for a
  // distance less than that of the other one, as a counter for its limit (counted.h).
  void count();

  // Is it the same in each turn? Then it is made in front.
  bool to_front(Val v);

  // The pointer that each turn begins with, when the value is its place in an order with others.
  const Walker* asked(Val v) const;

  void slots();
  void slots(uint32_t exit);

  // Where the loop has one way on, handles are made there.
  void behind(Renames& renames);

  bool has_other_way(Block out) const;

  // What all ways bring is one pointer's: its distance.
  void param_behind(Block out, uint32_t param);

  struct Address {
    Val distance = kNone;
    Val place = kNone;
    uint32_t bytes = 0;
  };

  struct Covered {
    uint64_t surely = 0;  // asked for in every turn
    uint64_t here = 0;    // in this block
    Block block = 0;
  };

  Function& f_;
  const Facts& facts_;
  const Ways& ways_;
  Constants* constants_ = nullptr;
  uint32_t number_;
  Loop loop_;
  Block front_;
  uint32_t unit_ = 0;
  std::vector<Walker> walkers_;
  ByKey<uint32_t> walker_;    // by handle; kNone: it is none
  ByKey<Val> distance_;       // by handle
  std::vector<Val> handles_;  // that have one
  ByKey<uint32_t> steps_;     // exits, by handle that is resolved at once
  ByKey<Address> addresses_;  // by what they were
  ByKey<Covered> covered_;    // by distance: bytes behind it
  NumberTable sure_;          // blocks that every turn goes through
  NumberTable resolved_;      // results of RESOLVE
  bool any_ = false;          // ... of which there are some
  std::vector<Question> questions_;
  std::vector<uint32_t> out_;
};

}  // namespace vm::native
