#define STC_ROW_3(...) &fused<__VA_ARGS__>,
#include "vm/exec/fused.h"
