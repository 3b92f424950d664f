"""Topics and services that sources use with the transport library of Gazebo."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PLUGIN = """#include <gz/transport/Node.hh>
void Lamp::OnLevel(const gz::msgs::Double & _msg) {{ level = _msg.data(); }}
bool Lamp::OnReset(const gz::msgs::Empty & _req, gz::msgs::Boolean & _rep) {{ return true; }}
void Lamp::Configure(const Entity & _entity, const Sdf & _sdf)
{{
  {}
}}
"""


@pytest.fixture
def review_plugin(repository, compare):
    """Review another body of a function of a plugin, and return the sentences and the breaking ones."""

    def run(old, new, text=PLUGIN):
        repository.commit({**MANIFEST, "arm/src/lamp.cc": text.format(old)})
        repository.write({"arm/src/lamp.cc": text.format(new)})
        result = compare(repository)
        return [sentence for subject in result.subjects for sentence in sentences(subject)], breaking(result)

    return run


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ('node.Subscribe("/level", &Lamp::OnLevel, this);', "subscriptions in Gazebo added: '/level' (Double)"),
        ('std::string topic{this->data->model.Name(_ecm) + "/level"}; node.Subscribe(topic, &Lamp::OnLevel, this);',
         "subscriptions in Gazebo added: '<model>/level' (Double)"),
        ('pub = this->data->node.Advertise<msgs::Odometry>("/model/" + model_->GetName() + "/odom");',
         "publishers in Gazebo added: '/model/<model>/odom' (Odometry)"),
        ('node->Advertise("/" + std::to_string(index_) + "/reset", &Lamp::OnReset, this);',
         "publishers in Gazebo added: '/<index>/reset' (Empty)"),
        ('node.Advertise("/reset", &Lamp::OnReset, this); node.AdvertiseService("/off", &Lamp::OnReset, this);',
         "services in Gazebo added: '/off' (Empty)"),
        ('node.Request("/world/" + _sdf->Get<std::string>("world") + "/set_pose", req, 100, rep, result);',
         "service clients in Gazebo added: '/world/<world>/set_pose'"),
        ('auto topic = transport::TopicUtils::AsValidTopic(make(a) + "/level"); node.Subscribe(topic, f);',
         "subscriptions in Gazebo added: '<...>/level'"),
        ('list.push_back(own); list.push_back(scope + "/level"); auto t = validTopic(list); node.Subscribe(t, f);',
         "subscriptions in Gazebo added: '<scope>/level'"),
    ],
)  # fmt: skip
def test_names_of_gazebo_are_told(review_plugin, code, expected):
    lines, broken = review_plugin("", code)
    assert expected in lines
    assert broken == []


@pytest.mark.parametrize("code", ["node.Subscribe(topic, f);", 'node.Subscribe(prefix + "/", f);'])
def test_names_without_a_known_text_are_left_out(review_plugin, code):
    lines, _ = review_plugin("", code)
    assert not any("Gazebo" in line for line in lines)


def test_calls_without_the_library_of_gazebo_are_left_out(review_plugin):
    text = PLUGIN.replace("#include <gz/transport/Node.hh>\n", "")
    lines, _ = review_plugin("", 'broker.Subscribe("/level", f);', text)
    assert not any("Gazebo" in line for line in lines)


def test_renamed_topic_of_gazebo_is_breaking(review_plugin):
    code = 'std::string topic{model.Name(_ecm) + "/level"}; node.Subscribe(topic, &Lamp::OnLevel, this);'
    _, broken = review_plugin(code, code.replace("/level", "/brightness"))
    assert broken == [
        "subscription in Gazebo '<model>/level' (Double) renamed to '<model>/brightness' (Double)",
    ]


def test_topic_of_gazebo_below_another_name_is_breaking(review_plugin):
    code = 'pub = node.Advertise<msgs::Double>(model + "/level");'
    _, broken = review_plugin(code, code.replace("/level", "/lamp/level"))
    assert broken == ["publisher in Gazebo '<model>/level' (Double) renamed to '<model>/lamp/level' (Double)"]


@pytest.mark.parametrize("other", ['prefix + "/level"', 'this->data->model_.Name(ecm) + "/level"', '"/a/level"'])
def test_name_of_gazebo_that_may_be_the_same_is_no_change(review_plugin, other):
    lines, broken = review_plugin('node.Subscribe(name + "/level", f);', f"node.Subscribe({other}, f);")
    assert not any("Gazebo" in line for line in lines)
    assert broken == []


def test_another_type_of_a_topic_of_gazebo_is_breaking(review_plugin):
    code = 'pub = node.Advertise<msgs::Double>("/level");'
    _, broken = review_plugin(code, code.replace("Double", "Float"))
    assert broken == ["publisher in Gazebo '/level': type Double -> Float"]


def test_lost_client_of_gazebo_breaks_nothing(review_plugin):
    lines, broken = review_plugin('node.Request("/reset", req, 100, rep, result);', "")
    assert "service clients in Gazebo removed: '/reset'" in lines
    assert broken == []
