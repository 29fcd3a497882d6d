#define STC_ROW_0(...) &fused<__VA_ARGS__>,
#include "vm/exec/fused.h"
