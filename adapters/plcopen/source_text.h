// The text of sources inside of a document: what elements have no place for (comments between
// declarations, tests, classes, namespaces) comes back when the document is read.
//
// addData of the project, <sources>, holds each source as it is, cut into parts: declarations and
// what stands between them. The elements of a declaration carry the number of its part and a digest
// of themselves and of that text. On reading, a part whose elements are as they were written gives
// its text; one that somebody changed gives what its elements say, with a warning (W0070) where
// that is less than the text said, and one that has no elements in XML always gives its text. Other
// tools leave all of it out.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "adapters/xml/document.h"

namespace plcopen {

inline constexpr const char* kSourcesData = "stc://plcopen-xml/sources";
inline constexpr const char* kPartData = "stc://plcopen-xml/part";

// A <data> of ours, in either format.
bool is_source_data(xml::Node data);

// --- writing
class SourceParts {
 public:
  explicit SourceParts(const base::SourceMap& sources);

  // `element` says what is declared at `at`. Its addData gets the number of the part.
  void tag(xml::Node element, base::SourcePos at) const;
  void put(xml::Node project) const;  // all of them, into its addData
  // Elements do not say all of what stands at `at`.
  void mark_partial(base::SourcePos at);
  // Writes into the complete document: digests, and how many elements each part has.
  void seal(xml::Node root) const;

 private:
  struct Part {
    uint32_t begin = 0;   // in the SourceMap
    uint32_t number = 0;  // 0: between declarations
    std::string text;     // in UTF-8
  };
  struct Source {
    std::string name;
    uint32_t begin = 0;  // in the SourceMap, where those of sources ascend
    std::vector<Part> parts;
  };
  uint32_t number_at(base::SourcePos at) const;  // 0: none
  void cut(std::string_view text, uint32_t begin, Source& out);

  std::vector<Source> sources_;
  std::set<uint64_t> partial_;  // numbers
  uint32_t last_ = 0;
};

// --- reading
class SourceTexts {
 public:
  // Takes the names of the sources that `root` holds.
  SourceTexts(xml::Node root, xml::Imported& out);

  // `text`, which it takes, is what `element` (of the document itself) says. False: it belongs to
  // no part.
  bool take(const xml::Document& document, xml::Node element, const std::string& name,
            std::string& text);
  // After the last element: the sources. Notes about parts that are no longer as they were; what
  // was found in the elements of others is gone, for the compiler sees their text.
  void finish(xml::Reporter& report);

 private:
  struct Part {
    xml::Node node;
    std::string hash;  // of its text
    uint32_t elements = 0;
    uint32_t same = 0;  // of them, as they were
    std::string names;  // of others
    std::string found;  // what they say
    bool used = false;
  };
  struct Source {
    xml::Node node;
    std::string name;
  };
  struct Extent {  // of an element in the document
    uint32_t begin = 0;
    uint32_t end = 0;
    const Part* part = nullptr;
  };
  static bool is_whole(const Part& part) {
    return part.names.empty() && part.same == part.elements;
  }
  void drop_findings(xml::Imported& out);

  std::vector<Source> sources_;
  std::map<uint64_t, Part> parts_;
  std::vector<Extent> extents_;  // of parts, as they were taken
};

}  // namespace plcopen
