#include "frontend/parse/declared_twice.h"

namespace frontend {

std::string declared_twice(const base::SourceMap& sources, std::string_view name,
                           base::SourceSpan here, base::SourceSpan other) {
  std::string text = "`" + std::string(name) + "` is declared twice";
  const base::SourceLocation at = sources.locate(other.begin);
  if (at.line == 0) return text;
  text += other.begin < here.begin ? "; first declared in " : "; declared again in ";
  const bool same_file = sources.locate(here.begin).file == at.file;
  text += same_file ? "line " : std::string(at.file) + ":";
  return text + std::to_string(at.line);
}

}  // namespace frontend
