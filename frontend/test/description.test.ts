import { describe, expect, it } from "vitest";
import { layOutTree, type TreeNode } from "../src/state/tidy-tree";
import { computeLineStates, tokenize, type LineState } from "../src/state/xml-tokens";

function formatTokens(line: string, state: LineState = "text"): string[] {
  return tokenize(line, state).tokens.map((token) => `${token.kind}:${token.text}`);
}

describe("colors of XML", () => {
  it("distinguish tags, attributes, values and expressions", () => {
    expect(formatTokens('<link name="${side}_wheel"/>')).toEqual([
      "punctuation:<",
      "tag:link",
      "punctuation: ",
      "attribute:name",
      "punctuation:=",
      'value:"',
      "expression:${side}",
      "value:_wheel",
      'value:"',
      "punctuation:/>",
    ]);
    expect(formatTokens("</xacro:macro> $(arg x)")).toEqual([
      "punctuation:</",
      "tag:xacro:macro",
      "punctuation:>",
      "text: ",
      "expression:$(arg x)",
    ]);
  });

  it("continue over line ends", () => {
    const lines = ["<a b='1", "2' c", ' = "x>y"', ">t<!-- a <b> -->", "<!-- c", "d --><e/>", "<![CDATA[ <f> ", "]]><?g", "h?>"];
    expect(computeLineStates(lines)).toEqual(["text", "'", "tag", "tag", "text", "comment", "text", "cdata", "instruction"]);
    expect(formatTokens("d --><e/>", "comment")).toEqual(["comment:d -->", "punctuation:<", "tag:e", "punctuation:/>"]);
  });

  it("lose no character of any text", () => {
    const texts = ['<a b="<>" c=\'"\'>', "<<>>", "a < b > c = 'd", '"<a', "</>", "<a b=c/d>", "<!DOCTYPE x>", "${a ${b"];
    for (const text of texts) {
      for (const state of ["text", "tag", "comment", "cdata", "instruction", '"', "'"] as const) {
        expect(tokenize(text, state).tokens.map((token) => token.text).join("")).toBe(text);
      }
    }
  });

  it("are the same for lines whose predecessors are skipped", () => {
    const text = '<a b="x > y"\nc="1">\n<!-- <x> --> <d e="\n"/>\n<f g=\'a>b\n\'/>';
    const lines = text.split("\n");
    let state: LineState = "text";
    const expectedStates = lines.map((line) => {
      const stateBefore = state;
      state = tokenize(line, state).state;
      return stateBefore;
    });
    expect(computeLineStates(lines)).toEqual(expectedStates);
  });

  it("are computed quickly for a megabyte", () => {
    const lines = Array.from({ length: 25_000 }, (_, i) => `    <link name="link_${i}" a="\${x}">text</link>`);
    const start = performance.now();
    computeLineStates(lines);
    expect(performance.now() - start).toBeLessThan(250);
  });
});

describe("the diagram's layout", () => {
  const createLeaf = (id: string, width = 10): TreeNode => ({ id, width, height: 4, children: [] });

  it("centers parents over their children, level by level", () => {
    const { nodes, width, height } = layOutTree({ ...createLeaf("a"), children: [createLeaf("b"), createLeaf("c")] }, 2, 6);
    expect(nodes.map(({ node, x, y, parent }) => [node.id, x, y, parent?.node.id])).toEqual([
      ["a", 11, 2, undefined],
      ["b", 5, 12, "a"],
      ["c", 17, 12, "a"],
    ]);
    expect([width, height]).toEqual([22, 14]);
  });

  it("never lets nodes overlap, and packs subtrees below each other", () => {
    const deepNode = { ...createLeaf("b"), children: [{ ...createLeaf("c"), children: [createLeaf("d", 60), createLeaf("e", 60)] }] };
    const { nodes, width } = layOutTree({ ...createLeaf("a"), children: [deepNode, createLeaf("f"), createLeaf("g")] }, 2, 6);
    for (const firstNode of nodes) {
      for (const secondNode of nodes) {
        if (firstNode === secondNode || firstNode.y !== secondNode.y) continue;
        expect(Math.abs(firstNode.x - secondNode.x)).toBeGreaterThanOrEqual((firstNode.node.width + secondNode.node.width) / 2 + 2);
      }
    }
    // f and g are above the wide leaves of c.
    expect(width).toBe(122);
  });

  it("handles chains of thousands of nodes", () => {
    let chain = createLeaf("end");
    for (let i = 0; i < 5000; i++) chain = { ...createLeaf(`${i}`), children: [chain] };
    expect(layOutTree(chain, 2, 6).nodes).toHaveLength(5001);
  });
});
