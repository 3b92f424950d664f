"""Keys that C++ sources read from YAML files with yaml-cpp."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
LOADER = """#include <yaml-cpp/yaml.h>
void load(const std::string & path)
{{
  const YAML::Node root = YAML::LoadFile(path);
  const auto limits = root["limits"];
  {}
}}
"""
GAIN = 'gain_ = limits["gain"].as<double>();'


@pytest.fixture
def review_loader(repository, compare):
    """Review another body of a function that loads a YAML file, and return the sentences and the breaking ones."""

    def run(old, new):
        repository.commit({**MANIFEST, "arm/src/loader.cpp": LOADER.format(old)})
        repository.write({"arm/src/loader.cpp": LOADER.format(new)})
        result = compare(repository)
        found = [sentence for subject in result.subjects for sentence in sentences(subject)]
        return found, breaking(result), [str(change.reason) for _, change in result.breaking_changes]

    return run


def test_renamed_key_is_breaking(review_loader):
    _, broken, reasons = review_loader(GAIN, GAIN.replace('"gain"', '"gain_p"'))
    assert broken == ["key of YAML files 'gain' renamed to 'gain_p'"]
    assert reasons == ["values that YAML files give to 'gain' have no effect"]


def test_removed_key_is_breaking(review_loader):
    _, broken, _ = review_loader(f'{GAIN} for (const auto & item : root["axes"]) {{ f(item["name"]); }}', GAIN)
    assert broken == ["keys of YAML files removed: 'axes', 'name'"]


def test_new_key_without_a_fallback_is_breaking(review_loader):
    _, broken, reasons = review_loader("", GAIN)
    assert broken == ["keys of YAML files added: 'gain'"]
    assert reasons == ["the program fails where 'gain' is not set"]


@pytest.mark.parametrize(
    "code",
    [
        'gain_ = limits["gain"].as<double>(1.0);',
        f'if (limits["gain"]) {GAIN}',
        f'if (!limits["gain"].IsDefined()) return; {GAIN}',
        f"try {{ {GAIN} }} catch (const YAML::Exception & error) {{ gain_ = 1.0; }}",
    ],
)
def test_new_key_that_files_may_leave_out_is_not_breaking(review_loader, code):
    lines, broken, _ = review_loader("", code)
    assert "keys of YAML files added: 'gain'" in lines
    assert broken == []


@pytest.mark.parametrize(
    "code",
    [
        'root["written"] = 1;',
        'root["a"]["written"] = 1;',
        'root["written"].push_back(1);',
        'root["written"] = 1; f(root["written"]);',
        'table["written"].as<int>();',
        "f(root[written]);",
    ],
)
def test_written_parts_and_other_containers_have_no_keys(review_loader, code):
    lines, broken, _ = review_loader("", code)
    assert not any("YAML" in line and "added" in line for line in lines if "'a'" not in line)
    assert broken == []


def test_key_that_another_function_reads_now_is_no_change(review_loader):
    lines, broken, _ = review_loader(GAIN, 'gain_ = read_number(limits, "gain");')
    assert not any("YAML" in line for line in lines)
    assert broken == []
