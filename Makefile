# Every target sets up what it needs below this folder and leaves the system as it is.
#
#   make demo    drive the robot of the tutorial, with laser and camera, through a simulated world in a browser
#   make test    all tests, those of the page in a real Chromium (fetched below .build/ where there is none)
#   make test-base ARGS=tests/urdf  a first test: without extras and the page, in .venv-base
#   make test-ros  the tests against real ROS 2 (Jazzy, or ROS=kilted), which is installed from PyPI below .build/
#   make test-zenoh-sdk  those against zenoh-ros2-sdk, which is installed from PyPI below .build/
#   make test-train  those that train networks, with PyTorch from PyPI below .build/
#   make test-editor  the extension for VS Code: types, style, tests with the real language server, package
#   make check   ruff, mypy, import-linter, the page's type check, generated files current
#   make bench   the figures the project promises, measured on this machine
#   make soak    an hour of processes over DDS: does anything grow, get lost or hang?
#   make soak-editor  an hour of random edits: does the memory of the language server grow?
#   make docs    the documentation site in site/
#   make reference  record anew what ros/xacro and urdfdom make of the descriptions in the tests
#   make release  wheel, source distribution, bill of materials and changelog in dist/, built twice and tried
#   make fuzz    a million hostile inputs for everything that reads files; see fuzz/README.md

PYTHON ?= python3
VERSION ?=
VENV := .venv$(if $(VERSION),-$(VERSION))
BIN := $(VENV)/bin
UV ?= $(shell command -v uv || echo .build/uv/bin/uv)
export UV

# uv looks into PATH for interpreters, where pyenv puts only the chosen one.
PYENV_BINS := $(wildcard $(shell pyenv root 2>/dev/null || echo /nowhere)/versions/3.1*/bin)
ifneq ($(PYENV_BINS),)
empty :=
export PATH := $(PATH):$(subst $(empty) $(empty),:,$(PYENV_BINS))
endif

# One line where the Python is not fit, before anything is made with it.
ifeq ($(VERSION)$(wildcard $(BIN)/python),)
ifneq ($(MAKECMDGOALS),clean)
UNFIT := $(shell $(PYTHON) -c 'import sys; v = sys.version_info[:2]; print("" if v >= (3, 10) else "is %d.%d" % v)' 2>/dev/null || echo "is not there")
ifneq ($(UNFIT),)
$(error Linkwright needs Python 3.10 or newer, and $(PYTHON) $(UNFIT); name another one, as in: make PYTHON=python3.12)
endif
endif
endif

# With AGAIN, what fails is run again; see docs/decisions/0037.
PYTEST = $(BIN)/$(if $(AGAIN),python tools/pytest_again.py,pytest)
# Files in the order of their names: those with few tests, which take longest, would else come last, one beside an idle core.
WORKERS = -n 2 --dist loadfile --no-loadscope-reorder

# All packages at once, so that no command waits for it; .ci/run leaves it to the modules that are used.
COMPILE ?= --compile-bytecode

MBOT := robots/my_robot_description/urdf/mbot_gazebo.xacro
LOCKED := .build/constraints.txt
RELEASE_TOOLS := .build/release-tools$(if $(VERSION),-$(VERSION))
PAGE_SOURCES := $(shell find frontend -path frontend/node_modules -prune -o -type f -print)

.PHONY: demo test test-base test-page test-editor test-program test-quick test-python read-tests coverage test-browser test-ros test-zenoh-sdk test-train check bench soak soak-editor fuzz reference release docs page lock format clean uv

# Ctrl-C is how the demo ends (status 130), which is no error; the shell has to outlive it to say so.
demo: $(VENV)/.ready
	@trap : INT; $(BIN)/linkwright sim playground $(MBOT) laser:=true camera:=true $(ARGS) || [ $$? = 130 ]

test: test-page test-editor test-program

# The unit tests of the page.
test-page: $(VENV)/.dev page
	$(BIN)/python tools/build_page.py test

# The extension for VS Code: types, style, its tests with the real language server, and the package.
test-editor: $(VENV)/.dev
	LINKWRIGHT_PYTHON=$(CURDIR)/$(BIN)/python $(BIN)/python tools/build_page.py --in editors/vscode run check

# All others.
test-program: $(VENV)/.dev page
	LINKWRIGHT_CHROMIUM=$$($(BIN)/python tools/chromium.py) $(PYTEST) $(WORKERS) $(ARGS)

test-quick: $(VENV)/.dev
	$(PYTEST) $(WORKERS) -m "not browser and not slow" $(ARGS)

# The tests of descriptions, or those named, without extras and the page, which take most of the time and the room. What needs them is
# left out. One room's tests take less time than a second process takes to begin.
BASE := .venv-base$(if $(VERSION),-$(VERSION))
ENGINE := diagnostics xmltree schema geometry packages xacro urdf sdf descriptions kinematics inertia lint inference picture
test-base: $(BASE)/.ready
	$(BASE)/bin/pytest $(if $(ARGS),,$(WORKERS)) -m "not browser and not slow and not extra" $(or $(ARGS),$(ENGINE:%=tests/%))

$(BASE)/.ready: pyproject.toml core/pyproject.toml core/engine_build.py hatch_build.py $(LOCKED) | $(UV)
	test -x $(BASE)/bin/python || $(UV) venv --quiet --python $(or $(VERSION),$(PYTHON)) $(BASE)
	LINKWRIGHT_WITHOUT_PAGE=1 $(UV) pip install --quiet --python $(BASE)/bin/python --constraints $(LOCKED) \
		--reinstall-package linkwright --no-sources --editable ./core --editable . --group test-base
	touch $@

# Those of the quick ones that may end otherwise with another Python.
test-python: $(VENV)/.dev
	$(PYTEST) $(WORKERS) -m "not browser and not slow" $$(grep '^tests/' tests/each_python.txt) $(ARGS)

# Write the bytecode of all modules of tests, which several workers would each compile; see docs/decisions/0041.
read-tests: $(VENV)/.dev
	$(BIN)/pytest --collect-only -qq >.build/read-tests.log || { cat .build/read-tests.log; exit 1; }

# The quick tests once more, with a look at which lines they reach; fails below the share named in pyproject.toml.
coverage: $(VENV)/.dev
	$(PYTEST) $(WORKERS) -m "not browser and not slow" -p pytest_cov.plugin --cov --cov-report=term:skip-covered $(ARGS)

test-browser: $(VENV)/.dev page
	LINKWRIGHT_CHROMIUM=$$($(BIN)/python tools/chromium.py) $(BIN)/pytest -m browser $(ARGS)

# Against real ROS 2 from wheels of PyPI, which there are for Linux and Python 3.12. The names of modules are Jazzy's.
ROS ?= jazzy
ROS_FOLDER := .build/ros$(patsubst -jazzy,,-$(ROS))
ROS_WHEELS_jazzy := ros-rclpy==7.1.6 ros-rmw-fastrtps-cpp==8.4.3 ros-common-interfaces==5.3.6 ros-test-msgs==2.0.3
ROS_WHEELS_kilted := ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 ros-common-interfaces==5.5.1 ros-test-msgs==2.3.0

test-ros: $(VENV)/.dev $(ROS_FOLDER)/types/.ready
	LINKWRIGHT_ROS_PYTHON=$(CURDIR)/$(ROS_FOLDER)/bin/python RMW_IMPLEMENTATION=rmw_fastrtps_cpp \
		$(if $(shell command -v g++),LINKWRIGHT_ROS_TYPES=$(CURDIR)/$(ROS_FOLDER)/types) \
		$(BIN)/pytest $(wildcard tests/wire/test_real_*.py) \
		tests/standins/test_field_rules.py $(if $(filter jazzy,$(ROS)),tests/standins/test_real_names.py) $(ARGS)

$(ROS_FOLDER)/.ready: | $(UV)
	$(UV) venv --quiet --clear --python 3.12 $(ROS_FOLDER)
	$(UV) pip install --quiet --python $(ROS_FOLDER)/bin/python $(ROS_WHEELS_$(ROS))
	touch $@

# Types that there are no wheels of, where there is a compiler: tf2's messages, and those of a package of one's own.
ROS_TYPES := $(patsubst tests/wire/types/%,%,$(wildcard tests/wire/types/*))
$(ROS_FOLDER)/types/.ready: tools/ros_types.py $(wildcard tests/wire/types/*/*/*.idl) $(ROS_FOLDER)/.ready
	mkdir -p $(@D)
	if command -v g++ > /dev/null; then AMENT_PREFIX_PATH=$(CURDIR)/$(ROS_FOLDER) PATH=$(CURDIR)/$(ROS_FOLDER)/bin:$$PATH \
		$(ROS_FOLDER)/bin/python tools/ros_types.py $(foreach type,$(ROS_TYPES),$(type)=tests/wire/types/$(type)) $(@D); fi
	touch $@

# Over Zenoh, with nodes that another program makes of it.
test-zenoh-sdk: $(VENV)/.dev .build/zenoh-sdk/.ready
	LINKWRIGHT_ZENOH_SDK_PYTHON=$(CURDIR)/.build/zenoh-sdk/bin/python $(BIN)/pytest tests/wire/zenoh/test_sdk.py $(ARGS)

.build/zenoh-sdk/.ready: $(VENV)/.ready | $(UV)
	$(UV) venv --quiet --clear --python $(BIN)/python .build/zenoh-sdk
	$(UV) pip install --quiet --python .build/zenoh-sdk/bin/python zenoh-ros2-sdk==0.1.8
	touch $@

# PyTorch is larger than everything else together, so that it has an environment of its own.
test-train: .build/train/.ready
	LINKWRIGHT_TESTS_TRAINING=1 .build/train/bin/pytest tests/vision/training $(ARGS)

.build/train/.ready: pyproject.toml | $(UV)
	$(UV) venv --quiet --clear --python $(or $(VERSION),3.12) .build/train
	$(UV) pip install --quiet --python .build/train/bin/python --no-sources -e ./core -e '.[train]' \
		babel hypothesis psutil pytest pytest-asyncio pytest-timeout pytest-xdist
	touch $@

WORDS := README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md pyproject.toml Makefile \
	benchmarks core courses docs editors frontend fuzz robots src tests tools
check: $(VENV)/.dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/codespell $(WORDS)
	MYPYPATH=src $(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python tools/lock.py check
	$(BIN)/python tools/pack_wheels.py --check
	$(BIN)/python tools/protocol_types.py --check
	$(BIN)/python tools/message_stubs.py --check
	$(BIN)/python tools/compatibility.py --check
	$(BIN)/python tools/command_reference.py --check
	$(BIN)/python tools/page_tables.py --check
	$(BIN)/python tools/substituted_names.py --check
	$(BIN)/python tools/node_parameters.py --check
	$(BIN)/python tools/simulator_plugins.py --check
	$(BIN)/python tools/node_topics.py --check
	$(BIN)/python tools/catalogs.py check
	$(BIN)/python tools/plain_words.py
	$(BIN)/python tools/rule_reference.py --check
	$(BIN)/python tools/language_reference.py --check
	$(BIN)/python tools/build_page.py run check

bench: $(VENV)/.dev page
	$(BIN)/python -m benchmarks.peers
	LINKWRIGHT_CHROMIUM=$$($(BIN)/python tools/chromium.py) $(BIN)/python -m benchmarks $(ARGS)

soak: $(VENV)/.dev page
	$(BIN)/python -m benchmarks.soak $(ARGS)

soak-editor: $(VENV)/.dev
	$(BIN)/python -m benchmarks.soak_editor $(ARGS)

fuzz: .build/fuzz/venv/.ready
	PYTHONPATH=src:. nice -n 15 .build/fuzz/venv/bin/python -m fuzz $(ARGS)

.build/fuzz/venv/.ready: | $(UV)
	$(UV) venv --quiet --clear --python $(or $(VERSION),3.11) .build/fuzz/venv
	$(UV) pip install --quiet --python .build/fuzz/venv/bin/python atheris msgspec numpy pyyaml regex
	touch $@

# What ros/xacro and urdfdom make of the descriptions in the tests, recorded in the repository. ros/xacro writes attributes
# otherwise from Python 3.13 on.
reference: $(VENV)/.dev .build/reference/.ready
	$(BIN)/python tools/reference_outputs.py $(ARGS)

.build/reference/.ready: | $(UV)
	$(UV) venv --quiet --clear --python '>=3.10,<3.13' .build/reference
	$(UV) pip install --quiet --python .build/reference/bin/python xacro==2.1.1 cmeel-urdfdom==6.0.0
	touch $@

# What it builds and tries, tools/release.py says; the programs that look at the results have an environment of their own.
release: $(RELEASE_TOOLS)/.ready
	$(RELEASE_TOOLS)/bin/python tools/release.py

$(RELEASE_TOOLS)/.ready: | $(UV)
	$(UV) venv --quiet --clear --python $(or $(VERSION),$(PYTHON)) $(RELEASE_TOOLS)
	$(UV) pip install --quiet --python $(RELEASE_TOOLS)/bin/python cyclonedx-bom==7.5.0 twine==7.0.0
	touch $@

docs: $(VENV)/.dev
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict  # --quiet would let warnings pass

page: $(VENV)/.dev
	$(BIN)/python tools/build_page.py

lock: | $(UV)
	$(PYTHON) tools/lock.py update $(ARGS)
	@echo "Now run python tools/pack_wheels.py in the environment"

format: $(VENV)/.dev
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

clean:
	rm -rf .venv .venv-* .build dist site frontend/node_modules editors/vscode/node_modules editors/vscode/dist src/linkwright/page/built

.build/uv/bin/uv:
	$(PYTHON) -m venv .build/uv
	.build/uv/bin/python -m pip install --quiet uv

# What each environment is made with.
uv: $(LOCKED) | $(UV)

$(LOCKED): uv.lock tools/lock.py
	mkdir -p .build
	$(PYTHON) tools/lock.py constraints > $@

# The program alone, installed so that changes to the sources count at once; the build makes the page.
$(VENV)/.ready: pyproject.toml core/pyproject.toml core/engine_build.py hatch_build.py $(LOCKED) $(PAGE_SOURCES) | $(UV)
	test -x $(BIN)/python || $(UV) venv --quiet --python $(or $(VERSION),$(PYTHON)) $(VENV)
	$(UV) pip install --quiet $(COMPILE) --python $(BIN)/python --constraints $(LOCKED) \
		--reinstall-package linkwright --no-sources --editable ./core --editable '.[all]'
	$(BIN)/python -m compileall -q src
	touch $@

# All packages but the program, which .ready and .dev then need not fetch: .ci/run fetches those of one Python while another one's
# environment is built.
$(VENV)/.packages: pyproject.toml core/pyproject.toml core/engine_build.py $(LOCKED) | $(UV)
	test -x $(BIN)/python || $(UV) venv --quiet --python $(or $(VERSION),$(PYTHON)) $(VENV)
	$(UV) pip install --quiet $(COMPILE) --python $(BIN)/python --constraints $(LOCKED) \
		--no-sources --editable ./core --requirements pyproject.toml --extra all --group dev
	touch $@

$(VENV)/.dev: $(VENV)/.ready
	$(UV) pip install --quiet $(COMPILE) --python $(BIN)/python --constraints $(LOCKED) --group dev
	touch $@
