#define STC_ROW_2(...) &fused<__VA_ARGS__>,
#include "vm/exec/fused.h"
