// Migrations at a start (docs/adr/0014-migrations.md): they run on retained values as they do in a
// change, each for itself: one that cannot be carried out ends no start.
#pragma once

#include <string>

#include "ir/bytecode/verify.h"
#include "online_change/plan/migration_calls.h"
#include "online_change/store/retain_map.h"

namespace online_change {

class RetainedMigrations {
 public:
  // From values of `from` to such of `to`. `code`: the version of both that has the functions.
  RetainedMigrations(const Migrations& migrations, const ir::Image& from, const ir::Image& to,
                     const ir::VerifiedImage& code);

  // Collects what is retained: op is of kind kMigrate, of an instance `id` of `to`, whose area was
  // at `old_area` and is at `new_area`.
  void add(const DiffOp& op, uint32_t id, uint32_t old_area, uint32_t new_area);
  void end_instance() { calls_.end_instance(); }
  // Makes them of `values`, into `out`. Where `as_changed`, values of `from` too, is not empty:
  // only those that are made of something that differs from it. What cannot be made stays as it is
  // in `out`; the answer says why, "" when all could.
  std::string run(base::ByteSpan values, base::ByteSpan as_changed, base::Bytes& out);

 private:
  void leave_out_unreadable();
  bool readable(const MigrationCall& call) const;
  void failed(const std::string& why);
  std::string run_on(base::ByteSpan values, base::ByteSpan as_changed, base::Bytes& out);

  const Migrations& migrations_;
  const ir::Image& from_;
  const ir::Image& to_;
  const ir::VerifiedImage& code_;
  RetainMap from_map_;
  RetainMap to_map_;
  Plan plan_;
  MigrationCalls calls_;
  std::string first_failure_;
  size_t failures_ = 0;
};

}  // namespace online_change
