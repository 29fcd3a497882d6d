#define STC_FUSED_PART 3
#include "vm/exec/fused.h"
