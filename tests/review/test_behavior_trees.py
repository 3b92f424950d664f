"""The lines of a review about behavior trees of BehaviorTree.CPP and Nav2."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

TREE = """<root main_tree_to_execute="MainTree">
  <BehaviorTree ID="MainTree">
    <PipelineSequence name="Navigate">
      <RateController hz="1.0">
        <ComputePath goal="{goal}" path="{path}"/>
      </RateController>
      <FollowPath path="{path}" controller_id="Fast"/>
      <SubTree ID="Recover"/>
    </PipelineSequence>
  </BehaviorTree>
  <BehaviorTree ID="Recover">
    <Sequence>
      <Spin angle="1.57"/>
      <Wait name="pause" duration="5"/>
    </Sequence>
  </BehaviorTree>
  <TreeNodesModel>
    <Action ID="Spin"><input_port name="angle"/></Action>
  </TreeNodesModel>
</root>
"""
PATH = "arm/trees/navigate.xml"
RECOVERY = TREE[TREE.index('  <BehaviorTree ID="Recover">') : TREE.index("  <TreeNodesModel>")]
SPIN, WAIT = '      <Spin angle="1.57"/>\n', '      <Wait name="pause" duration="5"/>\n'


@pytest.fixture
def compare_tree(repository, compare):
    """Review another text of the file, and return the sentences about it and the breaking ones."""

    def run(new: str, old: str = TREE):
        repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old})
        repository.write({PATH: new})
        result = compare(repository)
        return sentences(subject(result, PATH)), breaking(result)

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('hz="1.0"', 'hz="2"', "tree 'MainTree': RateController: hz 1.0 -> 2"),
        (' controller_id="Fast"', "", "tree 'MainTree': FollowPath: controller_id Fast removed"),
        (SPIN, "", "tree 'Recover': removed Spin (angle=1.57) in Sequence"),
        (SPIN, SPIN + '<BackUp distance="0.3"/>', "tree 'Recover': added BackUp (distance=0.3) in Sequence"),
        (SPIN + WAIT, WAIT + SPIN, "tree 'Recover': order in Sequence: Spin, Wait 'pause' -> Wait 'pause', Spin"),
        (SPIN, f"<Inverter>{SPIN}</Inverter>", "tree 'Recover': added Inverter around Spin in Sequence"),
        (
            SPIN,
            f'<Fallback name="try"><Home/>{SPIN}</Fallback>',
            "tree 'Recover': added Fallback 'try' with Home around Spin in Sequence",
        ),
        ('<SubTree ID="Recover"/>', "", "tree 'MainTree': removed SubTree 'Recover' in PipelineSequence 'Navigate'"),
        ('execute="MainTree"', 'execute="Recover"', "main_tree_to_execute MainTree -> Recover"),
        ("<root ", '<root BTCPP_format="4" ', "BTCPP_format 4 added"),
        ("  <TreeNodesModel>", '<include path="./x.xml"/><TreeNodesModel>', "includes the file './x.xml' now"),
        (
            '<input_port name="angle"/>',
            '<input_port name="angle"/><output_port name="done"/>',
            "description of the node 'Spin': done output added",
        ),
    ],
)
def test_changes_of_trees_are_reported(compare_tree, old, new, expected):
    assert old in TREE
    assert compare_tree(TREE.replace(old, new)) == ([expected], [])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('hz="1.0"', 'hz="1"'),
        ("    <Sequence>", "<!-- first turn -->\n    <Sequence>"),
        ("<Spin ", '<Action ID="Spin" '),
        ('<SubTree ID="Recover"/>', '<SubTree ID="Recover" _description="when lost"/>'),
    ],
)
def test_another_notation_is_no_change(repository, compare, old, new):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: TREE})
    repository.write({PATH: TREE.replace(old, new)})
    assert compare(repository).subjects == []


def test_node_that_moves_to_another_parent_is_one_change(compare_tree):
    new = TREE.replace(SPIN, "").replace(WAIT, f"{WAIT}<Retry>{SPIN}</Retry>")
    (added, order), _ = compare_tree(new)
    assert added == "tree 'Recover': added Retry around Spin in Sequence"
    assert order == "tree 'Recover': order in Sequence: Spin, Wait 'pause' -> Wait 'pause', Spin"


def test_equal_nodes_in_another_order_are_told_apart_by_the_nodes_in_them(compare_tree):
    spin, wait = (f"<Inverter>{node}</Inverter>" for node in (SPIN, WAIT))
    old = TREE.replace(SPIN, spin).replace(WAIT, wait)
    found, _ = compare_tree(old.replace(spin + wait, wait + spin), old)
    orders = [["Inverter of Spin", "Inverter of Wait 'pause'"], ["Inverter of Wait 'pause'", "Inverter of Spin"]]
    assert found == [f"tree 'Recover': order in Sequence: {' -> '.join(map(', '.join, orders))}"]


def test_tree_that_a_subtree_still_runs_is_breaking_when_it_is_gone(compare_tree):
    _, lost = compare_tree(TREE.replace(RECOVERY, ""))
    assert lost == ["runs the tree 'Recover', which no longer exists"]


def test_tree_of_another_file_can_be_run(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: TREE})
    repository.write({PATH: TREE.replace(RECOVERY, ""), "arm/trees/other.xml": f"<root>{RECOVERY}</root>"})
    assert breaking(compare(repository)) == []


def test_renamed_tree_is_one_change(compare_tree):
    found, lost = compare_tree(TREE.replace('"Recover"', '"Rescue"'))
    assert found == ["tree 'Recover' renamed to 'Rescue'"]
    assert lost == []


@pytest.mark.parametrize("new", [TREE.replace('"MainTree"', '"Mission"'), TREE.replace(RECOVERY, "")])
def test_lost_tree_that_a_source_starts_is_breaking(repository, compare, new):
    name = "MainTree" if "Mission" in new else "Recover"
    source = f'void run() {{ auto tree = factory.createTree("{name}"); }}\n'
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: TREE, "arm/src/run.cpp": source})
    repository.write({PATH: new})
    (change,) = [change for _, change in compare(repository).breaking_changes if "node" not in str(change.sentence)][:1]
    assert str(change.reason) == f"'arm/src/run.cpp' still names the tree '{name}'"


def test_added_and_removed_files_are_shown_with_their_trees(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: f"<root>{RECOVERY}</root>"})
    repository.write(
        {PATH: None, "arm/trees/models.xml": '<root><TreeNodesModel><Action ID="Go"/></TreeNodesModel></root>'}
    )
    result = compare(repository)
    assert sentences(subject(result, PATH)) == ["behavior tree removed: tree 'Recover' (Sequence, Spin, Wait 'pause')"]
    assert sentences(subject(result, "arm/trees/models.xml")) == ["behavior tree added: descriptions of the nodes Go"]
    assert breaking(result) == sentences(subject(result, PATH))
