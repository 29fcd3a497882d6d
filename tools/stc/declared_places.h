// Where the sources of a project declare what an image knows by name, for messages about images.
#pragma once

#include <map>
#include <string>

#include "base/source.h"
#include "frontend/parse/tree.h"
#include "tools/stc/project.h"

namespace stc {

class DeclaredPlaces {
 public:
  // Parses the project once more; who has nothing to say makes none. The spans are of its sources.
  explicit DeclaredPlaces(const Project& project);

  // Names without case: "Motor", "Motor.Start"; of a PROGRAM's type and a variable "Main.speed"; of
  // a global "level", "List.level"; of VAR_CONFIG the path. Of what nothing declares, the span is
  // without a place.
  base::SourceSpan unit(const std::string& name) const { return find(units_, name); }
  base::SourceSpan variable(const std::string& path) const { return find(variables_, path); }

 private:
  using Places = std::map<std::string, base::SourceSpan>;
  static base::SourceSpan find(const Places& places, const std::string& name);
  void add_pou(const frontend::PouDecl& pou, const std::string& prefix);
  void add_block(const Project& project, const frontend::Tree& tree,
                 const frontend::VarBlock& block, const frontend::VarBlock& head);
  void add_config(const Project& project, const frontend::Tree& tree,
                  const frontend::ConfigDecl& config);

  Places units_;
  Places variables_;
};

}  // namespace stc
