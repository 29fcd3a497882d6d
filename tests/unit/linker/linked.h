// IR text -> image that the verifier accepts.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "ir/bytecode/verify.h"
#include "ir/lower/lower.h"
#include "ir/program/text.h"
#include "ir/program/verify.h"
#include "linker/link.h"

namespace linker {

inline ir::Program parsed(std::string_view text) {
  base::Result<ir::Program> program = ir::parse_program(text);
  EXPECT_TRUE(program.ok()) << (program.ok() ? "" : program.error().text);
  if (!program.ok()) return ir::Program();
  const base::Status status = ir::verify(program.value());
  EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().text);
  return *std::move(program);
}

inline std::vector<ir::Object> objects_of(const ir::Program& program) {
  std::vector<ir::Object> objects;
  for (uint32_t i = 0; i < program.pous.size(); ++i) {
    base::Result<ir::Object> object = ir::lower(program, ir::PouId(i));
    EXPECT_TRUE(object.ok()) << (object.ok() ? "" : object.error().text);
    if (object.ok()) objects.push_back(*std::move(object));
  }
  return objects;
}

inline base::Result<ir::Image> try_link(std::string_view text, const Options& options = {}) {
  const ir::Program program = parsed(text);
  return link(program, objects_of(program), options);
}

// Links and has the verifier check the result.
inline ir::Image linked(std::string_view text, const Options& options = {}) {
  base::Result<ir::Image> image = try_link(text, options);
  EXPECT_TRUE(image.ok()) << (image.ok() ? "" : base::to_string(image.error()));
  if (!image.ok()) return ir::Image();
  const base::Result<ir::VerifiedImage> verified = ir::verify(ir::encode(image.value()));
  EXPECT_TRUE(verified.ok()) << (verified.ok() ? "" : base::to_string(verified.error()));
  return *std::move(image);
}

inline ir::Image relinked(const ir::Image& base, std::string_view text, Options options = {}) {
  options.base = &base;
  return linked(text, options);
}

inline ir::TypeId type_named(const ir::Image& image, std::string_view name) {
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    if (ir::same_name(image.types[ir::TypeId(i)].name, name)) return ir::TypeId(i);
  }
  ADD_FAILURE() << "no type " << name;
  return ir::TypeId(0);
}

// Offset of a member in the areas or values of its type.
inline uint32_t offset_of(const ir::Image& image, std::string_view type, std::string_view member) {
  const ir::TypeId id = type_named(image, type);
  const int32_t number = image.types.find_member(id, member);
  EXPECT_GE(number, 0) << member;
  return number < 0 ? 0 : image.layouts[id].member_offsets[static_cast<size_t>(number)];
}

// 0 when there is no such live instance.
inline uint32_t id_of(const ir::Image& image, std::string_view path) {
  for (uint32_t id = 1; id < image.instances.size(); ++id) {
    if (image.instances[id].live && image.instance_path(id) == path) return id;
  }
  return 0;
}

inline uint32_t area_of(const ir::Image& image, std::string_view path) {
  return image.instances[id_of(image, path)].data;
}

// A program of one POU without code.
inline std::string empty_pou(std::string_view kind, std::string_view name) {
  return "pou " + std::string(kind) + " " + std::string(name) + " self " + std::string(name) +
         "\n  b0:\n    return\n";
}

// Globals, Main's members and nothing else.
inline std::string simple(std::string_view globals, std::string_view members,
                          std::string_view types = "", std::string_view pous = "",
                          std::string_view body = "  b0:\n    return\n") {
  return "program P\n" + std::string(types) + "type G = globals\n" + std::string(globals) +
         "type Main = program\n" + std::string(members) +
         "globals G\ntask T period 1000000 priority 0\ninstance Main : Main task 0\n" +
         std::string(pous) + "pou program Main self Main\n" + std::string(body);
}

}  // namespace linker
