#define STC_FUSED_PART 0
#include "vm/exec/fused.h"
