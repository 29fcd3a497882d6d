#define STC_ROW_1(...) &fused<__VA_ARGS__>,
#include "vm/exec/fused.h"
