import type { FrameStore } from "./frames";

/** Returns the root of the tree with the most frames, the first if there are several; null if there are no frames. */
export function findLargestRoot({ names, parents }: Pick<FrameStore, "names" | "parents">): string | null {
  const sizes = new Map<number, number>();
  for (let row = 0; row < names.length; row++) {
    let root = row;
    for (let steps = 0; steps < names.length && (parents[root] ?? -1) >= 0; steps++) root = parents[root] ?? root;
    sizes.set(root, (sizes.get(root) ?? 0) + 1);
  }
  const [largestTree] = [...sizes].sort(([, a], [, b]) => b - a);
  return largestTree === undefined ? null : (names[largestTree[0]] ?? null);
}
