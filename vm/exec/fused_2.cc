#define STC_FUSED_PART 2
#include "vm/exec/fused.h"
