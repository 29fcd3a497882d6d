# What talks to people and to files is seldom, and so are forces: small rather than fast.
file(GLOB STC_SMALL ${CMAKE_SOURCE_DIR}/tools/stvm/*.cc ${CMAKE_SOURCE_DIR}/tools/common/*.cc
     ${CMAKE_SOURCE_DIR}/online_change/store/*.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/rename*.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/edge_names.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/embedded*.cc ${CMAKE_SOURCE_DIR}/base/unpack.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/no_program.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/identities.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/part_edits.cc ${CMAKE_SOURCE_DIR}/base/pack.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/canonical_value.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/located_*.cc ${CMAKE_SOURCE_DIR}/vm/runtime/own_outputs.cc
     ${CMAKE_SOURCE_DIR}/vm/io/driver.cc ${CMAKE_SOURCE_DIR}/online_change/apply/live_value.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/io.cc ${CMAKE_SOURCE_DIR}/vm/runtime/clocks.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/shared_globals.cc
     ${CMAKE_SOURCE_DIR}/online_change/package/fleet_file.cc
     ${CMAKE_SOURCE_DIR}/vm/native/*.cc ${CMAKE_SOURCE_DIR}/vm/native/x64/*.cc
     ${CMAKE_SOURCE_DIR}/online_change/diff/*.cc ${CMAKE_SOURCE_DIR}/online_change/package/*.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/variable_names.cc ${CMAKE_SOURCE_DIR}/base/nearest_name.cc
     ${CMAKE_SOURCE_DIR}/base/joined.cc ${CMAKE_SOURCE_DIR}/base/wrapped.cc
     ${CMAKE_SOURCE_DIR}/base/visible_text.cc ${CMAKE_SOURCE_DIR}/ir/program/task_policy.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_methods.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_next_frame.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/device*.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/disassemble*.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/socket*.cc ${CMAKE_SOURCE_DIR}/vm/runtime/recording.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/replay.cc ${CMAKE_SOURCE_DIR}/vm/io/csv*.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/protocol.cc ${CMAKE_SOURCE_DIR}/vm/runtime/connection.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/file_storage.cc ${CMAKE_SOURCE_DIR}/vm/runtime/write_set.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/thread_filter.cc ${CMAKE_SOURCE_DIR}/vm/runtime/realtime.cc
     ${CMAKE_SOURCE_DIR}/vm/io/shared_object.cc ${CMAKE_SOURCE_DIR}/vm/io/device_io.cc
     ${CMAKE_SOURCE_DIR}/vm/io/simulated_driver.cc ${CMAKE_SOURCE_DIR}/vm/io/shared_memory_driver.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/losses.cc ${CMAKE_SOURCE_DIR}/online_change/apply/chart*.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/migrator.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/leaving.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/plan_edit.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/values_back.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/pace.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/kept_data.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/used_data.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/standby_make.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/change*.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/lost_places.cc
     ${CMAKE_SOURCE_DIR}/online_change/diff/rename_hints.cc
     ${CMAKE_SOURCE_DIR}/online_change/diff/migrations.cc
     ${CMAKE_SOURCE_DIR}/online_change/diff/moved_parts.cc
     ${CMAKE_SOURCE_DIR}/online_change/diff/*_diff.cc ${CMAKE_SOURCE_DIR}/online_change/diff/areas.cc
     ${CMAKE_SOURCE_DIR}/vm/io/global_exchange.cc ${CMAKE_SOURCE_DIR}/vm/io/exchange_port.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/task_tables.cc ${CMAKE_SOURCE_DIR}/vm/exec/fusion.cc
     ${CMAKE_SOURCE_DIR}/vm/native/program.cc ${CMAKE_SOURCE_DIR}/vm/native/inline.cc
     ${CMAKE_SOURCE_DIR}/vm/native/unroll.cc
     ${CMAKE_SOURCE_DIR}/online_change/diff/place_moves.cc
     ${CMAKE_SOURCE_DIR}/online_change/package/plan_check.cc
     ${CMAKE_SOURCE_DIR}/ir/types/value_text.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_charts.cc
     ${CMAKE_SOURCE_DIR}/base/diagnostics*.cc ${CMAKE_SOURCE_DIR}/base/warning_policy.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/state_sum.cc ${CMAKE_SOURCE_DIR}/vm/runtime/summaries.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/task_activity.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/scheduler_states.cc
     ${CMAKE_SOURCE_DIR}/vm/load/left_outputs.cc ${CMAKE_SOURCE_DIR}/vm/runtime/forces.cc
     ${CMAKE_SOURCE_DIR}/vm/native/print.cc ${CMAKE_SOURCE_DIR}/vm/exec/describe.cc
     ${CMAKE_SOURCE_DIR}/vm/load/forced_code.cc ${CMAKE_SOURCE_DIR}/vm/load/origins.cc
     ${CMAKE_SOURCE_DIR}/vm/load/write*.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/symbols.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/leaf_walk.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/name_index.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/asked_values.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/values.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_versions.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_resources.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_migrations.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_overrides.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/verify.cc
     ${CMAKE_SOURCE_DIR}/online_change/plan/*.cc
     ${CMAKE_SOURCE_DIR}/online_change/package/package.cc
     ${CMAKE_SOURCE_DIR}/vm/load/generation.cc ${CMAKE_SOURCE_DIR}/vm/runtime/controller.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/native_maker.cc ${CMAKE_SOURCE_DIR}/vm/runtime/recorder.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/memory_report.cc ${CMAKE_SOURCE_DIR}/vm/runtime/scheduler.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/scheduler_events.cc ${CMAKE_SOURCE_DIR}/ir/types/*_text.cc
     ${CMAKE_SOURCE_DIR}/ir/types/*_parse.cc ${CMAKE_SOURCE_DIR}/ir/types/*_name*.cc
     ${CMAKE_SOURCE_DIR}/ir/types/inside.cc ${CMAKE_SOURCE_DIR}/ir/types/location.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_calls.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/call_needs.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_tables.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_tries.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_memory.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_types.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/pack_sources.cc ${CMAKE_SOURCE_DIR}/ir/types/reach.cc
     ${CMAKE_SOURCE_DIR}/ir/types/same_value_type.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_instances.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/image_queries.cc ${CMAKE_SOURCE_DIR}/vm/runtime/live_copy.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/mailbox.cc ${CMAKE_SOURCE_DIR}/vm/runtime/event_ring.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/frames.cc ${CMAKE_SOURCE_DIR}/vm/runtime/safe_outputs.cc
     ${CMAKE_SOURCE_DIR}/vm/load/truth_tables.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/image.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/regions.cc ${CMAKE_SOURCE_DIR}/ir/bytecode/value_ranges.cc
     ${CMAKE_SOURCE_DIR}/ir/bytecode/verify_checks.cc
     ${CMAKE_SOURCE_DIR}/vm/load/code_slots.cc ${CMAKE_SOURCE_DIR}/vm/load/last_reads.cc
     ${CMAKE_SOURCE_DIR}/ir/types/natural_layout.cc ${CMAKE_SOURCE_DIR}/ir/types/constants.cc
     ${CMAKE_SOURCE_DIR}/ir/types/member_finder.cc ${CMAKE_SOURCE_DIR}/ir/types/shared_bytes.cc
     ${CMAKE_SOURCE_DIR}/vm/load/same_code.cc ${CMAKE_SOURCE_DIR}/stdlib/native/dates.cc
     ${CMAKE_SOURCE_DIR}/ir/types/parts.cc ${CMAKE_SOURCE_DIR}/base/source.cc
     ${CMAKE_SOURCE_DIR}/base/check.cc ${CMAKE_SOURCE_DIR}/base/large_pages.cc
     ${CMAKE_SOURCE_DIR}/stdlib/native/from_text.cc
     ${CMAKE_SOURCE_DIR}/online_change/apply/standby.cc
     ${CMAKE_SOURCE_DIR}/vm/runtime/scheduler_exchange.cc
     ${CMAKE_SOURCE_DIR}/vm/exec/step_facts.cc)
# Where a native version spends its time while it is made.
foreach(name facts allocate allocator_state uses forward simplify numbers)
  list(REMOVE_ITEM STC_SMALL ${CMAKE_SOURCE_DIR}/vm/native/${name}.cc)
endforeach()
# Verbs that ask a controller, run a program once or speak to a broker, and what only these use.
set(STC_CLIENT)
foreach(name abort bench bridge change change_follow controller_client doctor edits events
        fate_view get image journal json_value names package_making plot question remote_client
        restart revoke set source status stop switch_steps switch_text times_text trace undo
        undo_only unit_table values waiting watch first_scans activity_text event_filter compiler
        hand_over replay hard_mode run run_resources run_timing player plan_trace
        rehearsal)
  list(APPEND STC_CLIENT ${CMAKE_SOURCE_DIR}/tools/stvm/${name}.cc)
endforeach()
file(GLOB more_clients ${CMAKE_SOURCE_DIR}/tools/stvm/fleet*.cc ${CMAKE_SOURCE_DIR}/tools/stvm/agent*.cc
     ${CMAKE_SOURCE_DIR}/tools/stvm/top*.cc ${CMAKE_SOURCE_DIR}/tools/stvm/timing*.cc)
foreach(name table help option_parser option_rows options dispatch pattern signed_content trust_file
        fleet_parts source_files ssh terminal)
  list(APPEND STC_CLIENT ${CMAKE_SOURCE_DIR}/tools/common/${name}.cc)
endforeach()
list(APPEND STC_CLIENT ${more_clients})
list(REMOVE_ITEM STC_SMALL ${STC_CLIENT})
# The back end of the other machine makes no code here.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  file(GLOB other_machine ${CMAKE_SOURCE_DIR}/vm/native/arm64/*.cc)
  list(APPEND STC_SMALL ${other_machine})
endif()
