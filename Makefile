# The front door. Every target works on a fresh Debian 12 with git and make only:
# scripts/setup.sh installs compiler and libraries when they are missing.
#
#   make          build/release/bin/stc and stvm
#   make demo     a bottling line, changed while it runs; tools that are built for this alone, in
#                 build/demo, soon rather than well
#   make demo-fleet   edits for the five controllers of a pumping district, one of which is wrong
#   make test     everything that has to hold, some minutes
#   make test-ansible   the module of Ansible in playbooks, which `make test` skips without Ansible
#   make bench    ST against C, and the compiler; writes docs/performance.md
#   make bench-large   the compiler on a million lines
#   make bench-pause   how long online changes stop the tasks; writes docs/pause.md
#   make asan     all tests under AddressSanitizer and UBSan (also: ubsan, and asan-clang by clang 16)
#   make asan-memory   those of them that touch memory most, as for every commit
#   make tsan     what has threads under ThreadSanitizer
#   make fuzz     a million inputs for each fuzz target under sanitizers; FUZZ='image|store' for some
#   make differential  5,000 random programs and changes on every tier, 5,000 changes of
#                      declarations against the oracle of fates; SEED=n begins elsewhere
#   make soak     long differential and hard mode runs
#   make maths    the mathematical functions against more precise ones; COUNT=n arguments each
#   make mutate   mistakes that the tests must see, one at a time; ONLY='C7 store' for some of them
#   make test-arm64  golden files and random programs on AArch64, under qemu
#   make minimal  build and test with every adapter off
#   make clang    build and test by clang 16, without a warning as by g++
#   make clang-read  clang 16 reads all sources of the product, without a warning, and builds nothing
#   make install PREFIX=DIR   stc, stvm, their documents and the unit of the service
#   make deb      the Debian packages, in build/release
#   make archives   static archives for amd64 and arm64 and an OCI image, in build/archives; each runs
#                   the bottling line in an empty root
#   make release  packages, archives and images of a version with their sums, in build/given_out
#   make format   clang-format over the whole tree

BUILD := build/release
JOBS := $(shell nproc)
# Some tests wait for what other processes do, and a core is free meanwhile.
TEST_JOBS := $(shell expr $(JOBS) + 1)

.PHONY: install deb archives release all build setup demo demo-fleet test test-ansible test-arm64 minimal minimal-scripts hard clang clang-read bench bench-large bench-pause format asan asan-clang asan-memory ubsan tsan fuzz differential soak maths mutate coverage docs clean

all: build

setup:
	@scripts/setup.sh

build: setup
	@cmake --preset release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS)

# Built to be seen soon: without optimisation and adapters, in two large units
# (scripts/batches.cmake).
demo:
	@scripts/setup.sh --build
	@echo "compiling the tools, most of it in two units: a minute and a half on two cores"
	@cmake --preset demo >/dev/null
	@cmake --build build/demo -j $(JOBS) --target stc stvm
	@scripts/demo.sh build/demo/bin

demo-fleet: setup
	@cmake --preset release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target stc stvm
	@scripts/demo_fleet.sh $(BUILD)/bin

test: build
	@ctest --test-dir $(BUILD) --output-on-failure -j $(TEST_JOBS)

test-ansible:
	@scripts/setup.sh ansible-core
	@cmake --preset release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target stc stvm
	@ctest --test-dir $(BUILD) --output-on-failure -R '^cli_ansible'

# TESTS: which of them, as a regular expression; EXCEPT: without these.
TESTS :=
EXCEPT :=
minimal: setup
	@cmake --preset minimal >/dev/null
	@cmake --build build/minimal -j $(JOBS)
	@ctest --test-dir build/minimal --output-on-failure -j $(TEST_JOBS) $(if $(TESTS),-R '$(TESTS)') $(if $(EXCEPT),-E '$(EXCEPT)')

# Of these those that are scripts, or TESTS of them, and no more is built than they run.
minimal-scripts: setup
	@cmake --preset minimal >/dev/null
	@cmake --build build/minimal -j $(JOBS) --target for_scripts
	@ctest --test-dir build/minimal --output-on-failure -j $(TEST_JOBS) -R '$(or $(TESTS),^(cli|meta)_)' $(if $(EXCEPT),-E '$(EXCEPT)')

# Every invariant is checked, those of hot loops too (base/check.h).
hard: setup
	@cmake --preset hard >/dev/null
	@cmake --build build/hard -j $(JOBS)
	@ctest --test-dir build/hard --output-on-failure -j $(TEST_JOBS) $(if $(TESTS),-R '$(TESTS)')

clang: setup
	@scripts/setup.sh clang-16
	@cmake --preset clang >/dev/null
	@cmake --build build/clang -j $(JOBS)
	@ctest --test-dir build/clang --output-on-failure -j $(TEST_JOBS)

clang-read: setup
	@scripts/setup.sh clang-16
	@cmake --preset $@ >/dev/null
	@cmake --build build/$@ -j $(JOBS) --target stc stvm

asan asan-clang ubsan: setup
	@[ $@ != asan-clang ] || scripts/setup.sh clang-16 libclang-rt-16-dev
	@cmake --preset $@ >/dev/null
	@cmake --build build/$@ -j $(JOBS)
	@ctest --test-dir build/$@ --output-on-failure -j $(TEST_JOBS)

empty :=
one_of = ($(subst $(empty) ,|,$(1)))
MEMORY := exec native runtime io online_change store workspace
asan-memory: setup
	@cmake --preset asan >/dev/null
	@cmake --build build/asan -j $(JOBS) --target $(MEMORY:%=test_%) golden fuzz_targets
	@ctest --test-dir build/asan --output-on-failure -j $(TEST_JOBS) -R '^(unit_$(call one_of,$(MEMORY))|golden_.*|fuzz_.*)$$'

THREADED := base runtime io resources exchange modbus mqtt fleet store workspace
tsan: setup
	@cmake --preset tsan >/dev/null
	@cmake --build build/tsan -j $(JOBS) --target $(THREADED:%=test_%)
	@ctest --test-dir build/tsan --output-on-failure -j $(TEST_JOBS) -R '^unit_$(call one_of,$(THREADED))$$'

# For another processor, so apart from `make test`: a build of its own, and qemu is slow.
test-arm64: setup
	@scripts/setup.sh g++-aarch64-linux-gnu qemu-user
	@cmake --preset arm64 >/dev/null
	@cmake --build build/arm64 -j $(JOBS) --target golden differential test_native test_stdlib
	@ctest --test-dir build/arm64 --output-on-failure --timeout 7200 -j $(TEST_JOBS) -R '^(golden_|unit_(native|stdlib)$$)'
	@qemu-aarch64 -R 64G -L /usr/aarch64-linux-gnu build/arm64/tests/differential 1 50
	@qemu-aarch64 -R 64G -L /usr/aarch64-linux-gnu build/arm64/tests/differential 1 50 --changes

coverage: setup
	@cmake --preset coverage >/dev/null
	@cmake --build build/coverage -j $(JOBS)
	@ctest --test-dir build/coverage --output-on-failure -j $(TEST_JOBS)

# Clouds give many processors one name: what tells them apart is their family and model.
PROCESSOR = $(shell sed -n 's/^$(1)[^:]*: //p' /proc/cpuinfo | head -1)
MACHINE := $(call PROCESSOR,model name) (family $(call PROCESSOR,cpu family) model $(call PROCESSOR,model	)), $(shell nproc) cores
bench: setup
	@cmake --preset release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target bench
	@bench/page.sh $(BUILD)/bench . "$(MACHINE)"

bench-large: setup
	@cmake --preset release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target bench_large
	@bench/page.sh $(BUILD)/bench . "$(MACHINE)"

bench-pause: setup
	@cmake --preset release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target bench_pause
	@$(BUILD)/bench/bench_pause --out docs/pause --machine "$(MACHINE)"
	@python3 scripts/wrap_pages.py docs/pause.md

# FUZZ: which targets, as a regular expression; FUZZ_RUNS: as many inputs for each of them; FUZZ_SEED:
# others. What is said of a memory error names the caller of malloc only: see docs/TESTING.md.
FUZZ := .
FUZZ_RUNS :=
FUZZ_SEED := 2
fuzz: export ASAN_OPTIONS := malloc_context_size=1:quarantine_size_mb=32:$(ASAN_OPTIONS)
fuzz: setup
	@cmake --preset asan >/dev/null
	@cmake --build build/asan -j $(JOBS) --target fuzz_targets
	@cd build/asan/tests/fuzz && grep -E '$(FUZZ)' targets.txt | \
	  xargs -P $(JOBS) -L 1 sh -c './$$0 "$$1" $(or $(FUZZ_RUNS),$$2) $(FUZZ_SEED)'

SEED := 1
PROGRAMS := 5000
DRAWINGS := 300
differential: build
	@$(BUILD)/tests/differential $(SEED) $(PROGRAMS) --shrink --jobs $(JOBS)
	@$(BUILD)/tests/differential $(SEED) $(PROGRAMS) --dialect iec --shrink --jobs $(JOBS)
	@$(BUILD)/tests/differential $(SEED) $(PROGRAMS) --changes --shrink --jobs $(JOBS)
	@python3 tests/fates/main.py $(BUILD)/tests/fates $(SEED) $(PROGRAMS) --jobs $(JOBS)
	@tests/cli/drawn_random.sh $(CURDIR) $(CURDIR)/$(BUILD) $(SEED) $(DRAWINGS)
	@tests/cli/second_reader.sh $(CURDIR) $(CURDIR)/$(BUILD) $(SEED) $(DRAWINGS)
	@tests/cli/drawn_changes.sh $(CURDIR) $(CURDIR)/$(BUILD) $(SEED) $(DRAWINGS)

# Hours, not minutes: eight hours of each of four simulated plants with changes, clients and faults;
# 100,000 random programs on every tier; identity changes at 100,000 scans of the line.
soak: build
	@$(BUILD)/tests/sim 1 4 --hours 8 --jobs $(JOBS)
	@$(BUILD)/tests/differential 1 100000 --shrink --jobs $(JOBS)
	@tests/cli/determinism.sh $(CURDIR) $(CURDIR)/$(BUILD) 100000

# 10^9 arguments of each function: hours.
COUNT := 1000000000
maths: build
	@$(BUILD)/tests/maths $(COUNT) $(SEED)

# In a copy of the sources with a build of its own. ONLY: parts of names or of files.
mutate: setup
	@cmake --preset release >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target mutate
	@$(BUILD)/tests/mutate tests/mutate/mutations.txt . build/mutate $(ONLY)

# Rewrites what is generated from the tables (docs/*.md) and the golden files.
docs: build
	@scripts/generate_docs.sh $(BUILD)/bin

format: setup
	@scripts/setup.sh clang-format-16
	@git ls-files '*.cc' '*.h' | xargs clang-format-16 -i

PREFIX := /usr/local
install: build
	@cmake -S . -B $(BUILD) -DCMAKE_INSTALL_PREFIX=$(PREFIX) >/dev/null
	@cmake --install $(BUILD) --strip

deb: build
	@cd $(BUILD) && cpack -G DEB

# Debian packages, archives and images of a version, tried in empty roots, with their sums.
release: build
	@scripts/setup.sh lintian g++-aarch64-linux-gnu qemu-user-static
	@scripts/release.sh build/given_out $(JOBS)

archives: setup
	@scripts/setup.sh g++-aarch64-linux-gnu qemu-user-static
	@scripts/archives.sh build/archives $(JOBS)

clean:
	@rm -rf build
