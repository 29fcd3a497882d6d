// The hand-made image of the bytecode tests, built into this program too.
#include "tests/unit/bytecode/sample_image.cc"
