"""The lines of a review about interfaces of ros2_control in C++ sources."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PATH = "arm/src/arm.cpp"
HARDWARE = """#include <arm.hpp>
std::vector<CommandInterface> Arm::export_command_interfaces() {
  std::vector<hardware_interface::CommandInterface> all;
  all.emplace_back(hardware_interface::CommandInterface("load", "mass", &mass_));
  all.push_back(hardware_interface::CommandInterface("tool", hardware_interface::HW_IF_POSITION, &tool_));
  return all;
}
std::vector<StateInterface> Arm::export_state_interfaces() {
  return {StateInterface("load", "ready", &ready_), StateInterface(info_.joints[0].name, "x", &x_)};
}
"""
CONTROLLER = """#include <hold.hpp>
InterfaceConfiguration Hold::command_interface_configuration() const {
  InterfaceConfiguration config;
  config.names.emplace_back("load/mass");
  config.names.push_back(joint_ + "/position");
  return config;
}
"""
UNCLAIMED = "on robots whose hardware does not have '{}', the controller does not start"
NOT_STARTED = "controllers that claim '{}' do not start"


@pytest.mark.parametrize(
    ("text", "old", "new", "sentence", "reason"),
    [
        (HARDWARE, '"mass"', '"weight"', "command interface 'load/mass' renamed to 'load/weight'",
         NOT_STARTED.format("load/mass")),
        (HARDWARE, "HW_IF_POSITION", "HW_IF_VELOCITY", "command interface 'tool/position' renamed to 'tool/velocity'",
         NOT_STARTED.format("tool/position")),
        (HARDWARE, 'StateInterface("load", "ready", &ready_), ', "", "state interfaces removed: 'load/ready'",
         NOT_STARTED.format("load/ready")),
        (HARDWARE, "  return all;", '  all.emplace_back("x", 1);\n  all.push_back(CommandInterface("load", "x", &x_));',
         "command interfaces added: 'load/x'", None),
        (CONTROLLER, "load/mass", "load/weight", "claimed interface 'load/mass' renamed to 'load/weight'",
         UNCLAIMED.format("load/weight")),
        (CONTROLLER, '  config.names.emplace_back("load/mass");\n', "",
         "claimed interfaces removed: 'load/mass'", None),
    ],
)  # fmt: skip
def test_interfaces_of_hardware_and_controllers(repository, compare, text, old, new, sentence, reason):
    other = CONTROLLER if text is HARDWARE else HARDWARE
    repository.commit({**MANIFEST, PATH: text, "arm/src/other.cpp": other})
    repository.write({PATH: text.replace(old, new, 1)})
    change = subject(compare(repository), PATH).changes[0]
    assert str(change.sentence) == sentence
    assert (None if change.reason is None else str(change.reason)) == reason


def test_names_of_other_lists_are_no_interfaces(repository, compare):
    text = 'void Arm::f() {\n  names.emplace_back("load/mass");\n}\n'
    repository.commit({**MANIFEST, PATH: text})
    repository.write({PATH: text.replace("mass", "weight")})
    assert not any("interface" in sentence for sentence in sentences(subject(compare(repository), PATH)))


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('["port"]', '["device"]', ["parameters of the hardware removed: 'port'"]),
        ('.at("slave")', '.at("module")',
         ["parameters of the hardware added: 'module'", "parameters of the hardware removed: 'slave'"]),
        ('["port"]', '.at("port")', ["parameter of the hardware 'port': required no -> yes"]),
        ('.at("slave");', '.at("slave");\n  if (names.count("p")) p_ = info_.hardware_parameters.at("p");',
         ["parameters of the hardware added: 'p'"]),
        ('.at("slave");', ('.at("slave");\n  if (info_.hardware_parameters.count("p") > 0) {\n'
         '    p_ = info_.hardware_parameters.at("p");\n  }'), []),
    ],
)  # fmt: skip
def test_parameters_that_hardware_reads_from_its_description_are_names(repository, compare, old, new, expected):
    text = "#include <hardware_interface/system_interface.hpp>\nint Arm::on_init(const HardwareInfo & info) {\n"
    text += '  port_ = info_.hardware_parameters["port"];\n  slave_ = info_.joints[j].parameters.at("slave");\n}\n'
    repository.commit({**MANIFEST, "arm/src/arm.cpp": text})
    assert old in text
    repository.write({"arm/src/arm.cpp": text.replace(old, new)})
    result = compare(repository)
    assert breaking(result) == expected
    assert not [line for line in sentences(result.subjects[0]) if "keys" in line]


HARDWARE = """#include <hardware_interface/system_interface.hpp>
int Arm::on_init(const HardwareInfo & info) {{
  {}
}}
PLUGINLIB_EXPORT_CLASS(arm::Arm, hardware_interface::SystemInterface)
"""
CONTROL = """<robot name="arm"><ros2_control name="a" type="system">
  <hardware><plugin>arm/Arm</plugin></hardware>{}
</ros2_control></robot>
"""


@pytest.mark.parametrize(
    ("line", "content", "reason"),
    [
        ("n_ = info_.sensors[0].state_interfaces.size();", "",
         "the hardware fails where the description does not have '<sensor>', such as arm/urdf/arm.xacro"),
        ("n_ = info_.sensors.at(0).name;", '<sensor name="imu"/>',
         "the hardware fails where the description does not have '<sensor>'"),
        ("if (info_.gpios.size() == 1) { n_ = info_.gpios[0].name; }", "", None),
        ("for (size_t i = 0; i < count_; i++) { n_ = info_.sensors[i].name; }", "", None),
    ],
)  # fmt: skip
def test_hardware_that_newly_reads_an_element_needs_it(repository, compare, line, content, reason):
    path = "arm/src/arm.cpp"
    repository.commit({**MANIFEST, "arm/urdf/arm.xacro": CONTROL.format(content), path: HARDWARE.format("n_ = 1;")})
    repository.write({path: HARDWARE.format(line)})
    (found,) = compare(repository).subjects
    assert [str(change.reason) for change in found.changes if change.reason] == [reason] * (reason is not None)


KEPT = """class Arm : public hardware_interface::SystemInterface {{
  double limit_ = {};
  void init() {{
    if (auto it = info_.hardware_parameters.find("limit"); it != info_.hardware_parameters.end()) {{
      limit_ = std::stod(it->second);
    }}
  }}
}};
"""


def test_a_parameter_of_hardware_has_the_value_of_its_variable_by_default(repository, compare):
    repository.commit({**MANIFEST, PATH: KEPT.format("0.5")})
    repository.write({PATH: KEPT.format("0.1")})
    assert sentences(subject(compare(repository), PATH))[0] == "parameter of the hardware 'limit': default 0.5 -> 0.1"


JOINTS = """#include <arm.hpp>
constexpr auto kForce = "force";
std::vector<StateInterface> Arm::export_state_interfaces() {
  std::vector<StateInterface> state_interfaces;
  for (const auto & joint : info_.joints) {
    state_interfaces.emplace_back(joint.name, hardware_interface::HW_IF_POSITION, &x_);
    state_interfaces.emplace_back(hardware_interface::StateInterface(joint.name, kForce, &f_));
  }
  for (auto & gpio : info_.gpios) {
    for (auto & item : gpio.state_interfaces) {
      state_interfaces.push_back(StateInterface(gpio.name + "_io", item.name + "_" + std::to_string(i), &io_[i]));
    }
  }
  return state_interfaces;
}
"""
FORCE = "    state_interfaces.emplace_back(hardware_interface::StateInterface(joint.name, kForce, &f_));\n"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (FORCE, "", "state interfaces removed: '<name>/force'"),
        ('"force"', '"torque"', "state interface '<name>/force' renamed to '<name>/torque'"),
        ("kForce, &f_", "prefix_ + kForce, &f_", ""),  # the prefix may be empty
        ("joint.name, kForce", '"tip", kForce', ""),
        (' + "_" + std::to_string(i)', "", "state interfaces removed: '<name>_io/<name>_<number>'"),
        ("HW_IF_POSITION", "item.name", ""),  # the description may name it
        ("const auto & joint :", "const auto & item :", ""),
        ("joint.name, kForce", "info_.joints[i].name, kForce", ""),
        (JOINTS[JOINTS.index("  std::vector<"):JOINTS.index("  return")], "", ""),  # ros2_control offers them
    ],
)  # fmt: skip
def test_interfaces_with_computed_names_that_hardware_no_longer_offers(repository, compare, old, new, expected):
    assert old in JOINTS
    repository.commit({**MANIFEST, PATH: JOINTS})
    repository.write({PATH: JOINTS.replace(old, new)})
    assert breaking(compare(repository)) == ([expected] if expected else [])


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("config.names.push_back(joint_ + kForce);", ["claimed interfaces added: '<name>/force'"]),
        ('config.names.push_back(joint_ + "/position");', []),
        ("config.names.push_back(joint_ + kForce + suffix_);", ["claimed interfaces added: '<name>/force<name>'"]),
        ("if (uses_force_) { config.names.push_back(joint_ + kForce); }", []),
        ("config.names.push_back(interface_);", []),
    ],
)
def test_interfaces_that_a_controller_newly_claims(repository, compare, line, expected):
    text = CONTROLLER.replace("#include <hold.hpp>", '#include <hold.hpp>\nconst std::string kForce = "/force";')
    repository.commit({**MANIFEST, PATH: text})
    repository.write({PATH: text.replace("  return", f"  {line}\n  return")})
    assert breaking(compare(repository)) == expected
