// Images made by hand, without front end and linker: types, one program or more, a
// simple layout that keeps what lives on. Enough to plan changes between them and to
// carry them out on a plain byte vector.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ir/bytecode/image.h"
#include "online_change/apply/transfer.h"
#include "online_change/plan/plan.h"

namespace hand_made {

struct Var {
  std::string name;
  ir::TypeId type;
  uint64_t init = 0;  // scalars
  bool constant = false;
};

class Version {
 public:
  ir::Image image;

  ir::TypeId elementary(ir::Kind kind) { return image.types.elementary(kind); }
  ir::TypeId array(ir::TypeId element, std::vector<ir::Dimension> dims) {
    return image.types.own().array(element, std::move(dims));
  }
  ir::TypeId enumeration(const std::string& name, std::vector<ir::EnumLiteral> literals);
  ir::TypeId structure(const std::string& name, const std::vector<Var>& vars) {
    return declare(ir::Kind::kStruct, name, vars);
  }
  ir::TypeId block(const std::string& name, const std::vector<Var>& vars) {
    return declare(ir::Kind::kFunctionBlock, name, vars);
  }
  void globals(const std::vector<Var>& vars) { globals_ = vars; }
  void program(const std::string& name, const std::vector<Var>& vars) {
    programs_.emplace_back(name, declare(ir::Kind::kProgram, name, vars));
  }

  // Lays out, numbers and places everything; members and instances of `base` stay.
  // `slack` bytes behind each area. `move`: every instance gets a new area.
  void link(const Version* base = nullptr, uint32_t slack = 16, bool move = false);

 private:
  ir::TypeId declare(ir::Kind kind, const std::string& name, const std::vector<Var>& vars);
  void lay_out(ir::TypeId id, const ir::Image* base);
  void lay_out_members(ir::TypeId id, const ir::Image* base);
  void add_instance(uint32_t parent, const std::string& name, ir::TypeId type, const Version* base,
                    bool move);
  void add_children(uint32_t id, const Version* base, bool move);
  void add_slots(uint32_t id, ir::TypeId type, uint32_t at, const std::string& path,
                 const Version* base, bool move);
  void write_initial(uint32_t at, ir::TypeId type, uint64_t init);
  void write_bytes(uint32_t at, uint64_t bits, uint32_t size);
  uint32_t find_old(const Version& base, uint32_t id) const;

  std::vector<Var> globals_;
  std::vector<std::pair<std::string, ir::TypeId>> programs_;
  std::vector<bool> laid_out_;
  uint32_t slack_ = 16;
  uint32_t next_area_ = ir::kDataBegin;
  std::map<uint32_t, base::Bytes> initial_;
};

// Data memory of a running version, and changes carried out on it.
class Running {
 public:
  explicit Running(const Version& version);

  std::string get(const std::string& path) const;
  void set(const std::string& path, const std::string& value);
  base::Digest hash() const;

  // Plans, checks (V17, both ways) and switches; keeps what undo needs.
  online_change::Plan change(const Version& next);
  void undo();
  const std::vector<online_change::Loss>& losses() const { return losses_; }
  std::vector<uint8_t>& memory() { return memory_; }

 private:
  const Version* version_;
  const Version* previous_ = nullptr;
  std::vector<uint8_t> memory_;
  online_change::Plan forward_;
  online_change::Plan inverse_;
  std::unique_ptr<online_change::Transfer> transfer_;
  std::unique_ptr<online_change::Transfer> back_;
  std::vector<online_change::Loss> losses_;
};

// The row for that path and fate; fails the test when there is none.
const online_change::FateRow* find_row(const online_change::Plan& plan, const std::string& path);

}  // namespace hand_made
