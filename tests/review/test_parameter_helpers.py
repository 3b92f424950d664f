"""Parameters that sources read with functions of their own, and elements of SDF that plugins read."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
HEAD = "#include <ros/ros.h>\nvoid Arm::init() {{\n  {}\n}}\n"


@pytest.mark.parametrize(
    ("path", "call", "expected"),
    [
        ("a.cpp", 'getRequiredParam(nh, "gain", &gain_);', "parameters added: 'gain'"),
        ("a.cpp", 'rate_ = declare_or_get_param<double>(node, "rate", 5.0);', "parameters added: 'rate' (5.0)"),
        ("a.cpp", 'declareParameter("speed", rclcpp::ParameterValue(0.3));', "parameters added: 'speed' (0.3)"),
        ("a.cpp", 'auto p = get_parameter("port").as_int();', "parameters added: 'port'"),
        ("a.cpp", 'auto s = this->sdf->Get<double>("noise", 0.1).first;',
         "parameters of the plugin added: 'noise' (0.1)"),
        ("a.cc", 'if (_sdf->HasElement("topic")) f();', "parameters of the plugin added: 'topic'"),
        ("a.cc", 'n_ = SdfParamDouble(*_sdf, "scale", 2.5);', "parameters of the plugin added: 'scale' (2.5)"),
        ("a.cc", 'auto ray = sdf_->GetElement("ray"); auto n = ray->GetElement("n"); f(n->Get<float>("mean"));',
         "parameters of the plugin added: 'ray', 'n', 'mean'"),
        ("a.cc", 'const sdf::ElementPtr& e = g(); f(e->Get<double>("mean", 0.2));',
         "parameters of the plugin added: 'mean' (0.2)"),
        ("a.cc", 'm_ = _sdf->GetElement("noise")->GetElement("x")->Get<double>("mean", 0.2).first;',
         "parameters of the plugin added: 'noise', 'x', 'mean' (0.2)"),
        ("a.cc", 't_ = _sdf->GetElement("noise")->GetAttribute("kind")->GetAsString();',
         "parameters of the plugin added: 'noise', 'kind'"),
        ("a.cc", 'void f(const std::shared_ptr<const sdf::Element> &e) { m_ = e->Get<double>("mean"); }',
         "parameters of the plugin added: 'mean'"),
        ("a.cc", 'const std::string kNames[2] = {"front", "rear"}; f(_sdf->Get<std::string>(kNames[i]));',
         "parameters of the plugin added: 'front', 'rear'"),
        ("a.cc", 'const char * kGain = "gain"; f(_sdf->Get<double>(kGain));', "parameters of the plugin added: 'gain'"),
        ("a.cpp", 'gazebo_ros_->getParameter<double>(rate_, "updateRate", 9.0);',
         "parameters of the plugin added: 'updateRate' (9.0)"),
        ("a.py", "gain = load_param('gain', 2.0)", "parameters added: 'gain' (2.0)"),
    ],
)  # fmt: skip
def test_parameters_of_functions_of_the_repository_are_told(repository, compare, path, call, expected):
    text = (lambda code: f"import rclpy\n{code}\n") if path.endswith(".py") else HEAD.format
    repository.commit({**MANIFEST, f"arm/src/{path}": text("")})
    repository.write({f"arm/src/{path}": text(call)})
    assert expected in sentences(subject(compare(repository), f"arm/src/{path}"))


@pytest.mark.parametrize(
    "call",
    [
        'setParam("gain", 1);',
        'load_parameters("gains.yaml");',
        'loadParam("config/gains.yaml");',
        'f("gain");',
        'auto e = mesh->GetElement("part"); e->Get<double>("gain");',
        'mesh->GetElement("part")->Get<double>("gain");',
    ],
)
def test_other_calls_read_no_parameter(repository, compare, call):
    repository.commit({**MANIFEST, "arm/src/a.cpp": HEAD.format("")})
    repository.write({"arm/src/a.cpp": HEAD.format(call)})
    lines = sentences(subject(compare(repository), "arm/src/a.cpp"))
    assert not any(line.startswith("parameter") for line in lines)


def test_element_that_a_plugin_no_longer_reads_is_breaking(repository, compare):
    repository.commit({**MANIFEST, "arm/src/a.cpp": HEAD.format('_sdf->Get<double>("noise");')})
    repository.write({"arm/src/a.cpp": HEAD.format('_sdf->Get<double>("noise_level");')})
    (sentence,) = breaking(compare(repository))
    assert sentence == "parameter of the plugin 'noise' renamed to 'noise_level'"


def test_a_default_behind_a_condition_that_the_parameter_is_set_is_none(repository, compare):
    text = 'void f() {\n  if (nh.hasParam("x")) { nh.param("x", x_, 0.0); }\n  nh.param("y", y_, 0.0);\n}\n'
    repository.commit({**MANIFEST, "arm/a.cpp": "void f() {}\n"})
    repository.write({"arm/a.cpp": text})
    assert "parameters added: 'x', 'y' (0.0)" in sentences(compare(repository).subjects[0])


@pytest.mark.parametrize("function", ["declare_double", "params_.declare_double", "this->registerParameter<double>"])
def test_a_function_that_declares_a_parameter_is_known_by_its_name(repository, compare, function):
    text = f'void f() {{ {function}("rate", 0.5); }}\n'
    repository.commit({**MANIFEST, "arm/a.cpp": text})
    repository.write({"arm/a.cpp": text.replace("0.5", "0.7")})
    assert sentences(compare(repository).subjects[0]) == ["parameter 'rate': default 0.5 -> 0.7"]
