import { expect, it } from "vitest";
import { largestRoot } from "../src/state/frame-tree";

it("is the root of the tree that has most frames", () => {
  expect(largestRoot({ names: ["odom", "a", "base", "left", "right"], parents: [-1, 0, -1, 2, 3] })).toBe("base");
  expect(largestRoot({ names: ["left", "base"], parents: [1, -1] })).toBe("base");
});

it("is none without frames, and ends where frames are parents of one another", () => {
  expect(largestRoot({ names: [], parents: [] })).toBeNull();
  expect(largestRoot({ names: ["a", "b"], parents: [1, 0] })).not.toBeNull();
});
