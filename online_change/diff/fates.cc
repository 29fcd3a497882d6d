#include "online_change/diff/fates.h"

#include "base/check.h"

namespace online_change {

const char* fate_name(Fate fate) {
  switch (fate) {
    case Fate::kKept:
      return "kept";
    case Fate::kMoved:
      return "moved";
    case Fate::kConverted:
      return "converted";
    case Fate::kInitialised:
      return "initialised";
    case Fate::kDropped:
      return "dropped";
  }
  base::check(false, "a fate that fate_name() knows");
  return "";
}

}  // namespace online_change
