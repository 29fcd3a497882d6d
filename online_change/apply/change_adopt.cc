// A trial that goes on in another process (D4): the way back of each edit is made again, by making
// the change once more in a memory of its own.
#include "base/memory_limit.h"
#include "online_change/apply/pending.h"

namespace online_change {

base::Status Change::adopt(base::ByteSpan package, const ir::VerifiedImage& before,
                           const ir::VerifiedImage& after, base::ByteSpan retained) {
  if (prepares()) return not_in("idle or on trial");
  if (base::Status free = room(); !free.ok()) return free;
  return base::within_memory([&] { return adopt_steps(package, before, after, retained); }, [] {
    return base::Status(base::Error{base::Refusal::kNoMemory, {}});
  });
}

base::Status Change::adopt_steps(base::ByteSpan bytes, const ir::VerifiedImage& before,
                                 const ir::VerifiedImage& after, base::ByteSpan retained) {
  base::Result<Package> package = decode(bytes, before.encoded());
  if (!package.ok()) return package.error();
  if (package->base != before.digest()) return stale_base(package->base, before.digest());
  const bool same =
      same_data({before.image(), before.encoded()}, {after.image(), after.encoded()});
  if (!same || !leaves_all(*package)) {
    base::Status sound = check_package(*package, before.image(), after.image());
    if (!sound.ok()) return sound;
  }
  auto edit =
      std::make_unique<Pending>(std::move(*package), before, after, Strategy::kInPlace, same);
  edit->count_undo_work();
  if (base::Status imagined = imagine_switch(*edit, retained); !imagined.ok()) return imagined;
  if (state_ == State::kTrial) rest();
  pending_ = std::move(edit);
  state_ = State::kTrial;
  return base::Ok{};
}

// What a switch notes, of values that nobody else sees. The code of a migration is that of the
// newer version; where that does not run, it is made for this, and prime() makes it again.
base::Status Change::imagine_switch(Pending& edit, base::ByteSpan retained) {
  const ir::Image& before = edit.old_image.image();
  base::Result<vm::Memory> scratch = vm::Memory::reserve();
  if (!scratch.ok()) return scratch.error();
  uint8_t* const memory = scratch->data();
  vm::write_initial_data(before, memory);
  vm::write_retained(before, retained, memory);
  Plan& forward = edit.package.forward;
  Plan& inverse = edit.package.inverse;
  if (!forward.calls.empty() || !inverse.calls.empty()) {
    const vm::Generation* code = &controller_.generation();
    if (edit.new_image.digest() != controller_.verified().digest()) {
      auto made = controller_.prepare(edit.new_image);
      if (!made.ok()) return made.error();
      retired_ = std::move(*made);
      code = retired_.get();
    }
    auto there = Migrator::make(forward, edit.old(), edit.new_image.image(), *code);
    if (!there.ok()) return there.error();
    auto back = Migrator::make(inverse, edit.new_image.image(), edit.old(), *code);
    if (!back.ok()) return back.error();
    edit.migrate = std::move(*there);
    edit.migrate_back = std::move(*back);
  }
  if (edit.migrate) {
    if (base::Status run = edit.migrate->run(memory); !run.ok()) return run;
  }
  const OnLoss allowed = [](const Loss&) { return true; };
  edit.charts.note(memory);
  for (const Piece& piece : edit.early.pieces()) {
    (void)edit.early.move(piece, memory, memory, nullptr);
  }
  const bool made = edit.forward.read(memory, allowed, {}) && edit.forward.save(memory, {}) &&
                    edit.backward.remember(memory, {}) && edit.forward.write(memory, {});
  if (!made) return abandoned("when it was resumed");
  (void)edit.handles.forward(memory, true, {});
  if (edit.migrate_back) edit.migrate_back->note(memory);
  return base::Ok{};
}

}  // namespace online_change
