// For programs that allocate more and more and then end, as a compiler does.
#pragma once

namespace tools {

// From now on, the heap keeps what is freed, and does not gather small pieces to give them back:
// that is a tenth of the time of a compilation. Without effect where the C library has no such
// settings.
void keep_freed_memory();

// The same of large pieces, for programs that stay and need as much again and again: pages that
// they give back cost more than what is done with them.
void keep_large_pieces();

}  // namespace tools
