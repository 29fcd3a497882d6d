// From the bytecode of a POU to the Function that registers are allocated for.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vm/exec/tier.h"
#include "vm/load/generation.h"
#include "vm/native/facts.h"
#include "vm/native/inline.h"

namespace vm::native {

// Does the hard mode leave this POU to the interpreter?
bool is_interpreted_at_random(const TierOptions& options, uint32_t pou);

// Functions of small POUs, made when the first caller asks. Borrows everything.
class Bodies {
 public:
  Bodies(const ir::Image& image, const ImageFacts& common, const std::vector<PouEntry>& pous,
         const TierOptions& options)
      : image_(image), common_(common), pous_(pous), options_(options), states_(pous.size()) {}
  const ImageFacts& common() const { return common_; }
  // What `caller` has in the place of a call of POU number `pou`; null: it calls.
  const Body* body(uint32_t pou, uint32_t caller);
  const ir::Unit* units(uint32_t pou) const { return pous_[pou].code; }

 private:
  struct State {
    bool asked = false;
    std::unique_ptr<Body> body;
  };
  const ir::Image& image_;
  const ImageFacts& common_;
  const std::vector<PouEntry>& pous_;
  const TierOptions& options_;
  std::vector<State> states_;
};

// `inlined`: the POUs whose bodies are in it.
base::Result<Function> make_function(const ir::Image& image, Bodies& bodies, uint32_t pou,
                                     std::vector<uint32_t>& inlined);

// The Function of every POU as text, or why there is none, for `stc dump --native`.
std::string functions_text(const ir::Image& image);

}  // namespace vm::native
