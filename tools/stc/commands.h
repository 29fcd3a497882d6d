// The commands of stc, one file each. Each returns the exit code.
#pragma once

#include "tools/common/dispatch.h"

namespace stc {

using tools::Entry;

extern const Entry kCheck;
extern const Entry kBuild;
extern const Entry kTest;
extern const Entry kPackage;
extern const Entry kFleet;
extern const Entry kDiff;
extern const Entry kFormat;
extern const Entry kImport;
extern const Entry kExport;
extern const Entry kDraw;
extern const Entry kDump;
extern const Entry kSource;
extern const Entry kXref;
extern const Entry kExplain;
extern const Entry kKey;

}  // namespace stc
