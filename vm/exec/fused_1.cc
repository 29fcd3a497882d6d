#define STC_FUSED_PART 1
#include "vm/exec/fused.h"
