// What the heap of the C library does for programs that are known: a compiler allocates more and
// more and then ends, a controller allocates in the beginning what it keeps. Without effect where
// the library has no such settings.
#pragma once

#include <cstddef>

namespace tools {

// From now on, the heap keeps what is freed, and does not gather small pieces to give them back:
// that is a tenth of the time of a compilation.
void keep_freed_memory();

// Keeps large pieces, for programs that stay and need as much again and again: pages that
// they give back cost more than what is done with them.
void keep_large_pieces();

// At least `bytes` are going to be allocated soon and kept: they come from large pages where the
// system has them, each of which costs little more than a small one. Does nothing for less than
// some large pages. Before there are threads.
void expect_pieces(size_t bytes);

}  // namespace tools
