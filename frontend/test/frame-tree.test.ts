import { expect, it } from "vitest";
import { findLargestRoot } from "../src/state/frame-tree";

it("the root is that of the tree with most frames", () => {
  expect(findLargestRoot({ names: ["odom", "a", "base", "left", "right"], parents: [-1, 0, -1, 2, 3] })).toBe("base");
  expect(findLargestRoot({ names: ["left", "base"], parents: [1, -1] })).toBe("base");
});

it("there is no root without frames, and cycles of parents end", () => {
  expect(findLargestRoot({ names: [], parents: [] })).toBeNull();
  expect(findLargestRoot({ names: ["a", "b"], parents: [1, 0] })).not.toBeNull();
});
