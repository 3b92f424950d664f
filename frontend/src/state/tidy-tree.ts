/** A node to be laid out: its size in any unit, and its children. */
export interface TreeNode {
  readonly id: string;
  readonly width: number;
  readonly height: number;
  readonly children: readonly TreeNode[];
}

/** A node with the position of its center; y points down. */
interface PlacedNode {
  readonly node: TreeNode;
  readonly x: number;
  readonly y: number;
  readonly parent: PlacedNode | null;
}

export interface TidyTree {
  readonly nodes: readonly PlacedNode[];
  readonly width: number;
  readonly height: number;
}

/** The left and right edges of a subtree on each level, relative to the center of its top node. */
interface Contour {
  left: number[];
  right: number[];
}

/**
 * Lays out a tree with its root at the top: each level in a row, each parent centered over its children, and subtrees
 * as close to each other as `gap` permits on every level (after Reingold and Tilford).
 */
export function layOutTree(root: TreeNode, gap: number, levelGap: number): TidyTree {
  const entries = listInPreorder(root);
  const offsets = new Map<TreeNode, number>();
  const contours = new Map<TreeNode, Contour>();
  // Go from the leaves up, without recursion, because chains may be thousands of nodes long.
  for (const { node } of [...entries].reverse()) contours.set(node, placeChildren(node, contours, offsets, gap));
  const rows = computeRowTops(entries, levelGap);
  const rootContour = contours.get(root) ?? { left: [0], right: [0] };
  const left = Math.min(...rootContour.left);
  const placedNodes = new Map<TreeNode, PlacedNode>();
  const nodes = entries.map(({ node, depth, parent: parentNode }) => {
    const parent = (parentNode && placedNodes.get(parentNode)) ?? null;
    const x = parent ? parent.x + (offsets.get(node) ?? 0) : -left;
    const { top = 0, height = 0 } = rows[depth] ?? {};
    const placedNode = { node, x, y: top + height / 2, parent };
    placedNodes.set(node, placedNode);
    return placedNode;
  });
  const lastRow = rows.at(-1);
  return { nodes, width: Math.max(...rootContour.right) - left, height: lastRow ? lastRow.top + lastRow.height : 0 };
}

/** Places the children of a node next to each other and returns the contour of the whole. */
function placeChildren(
  node: TreeNode,
  contours: ReadonlyMap<TreeNode, Contour>,
  offsets: Map<TreeNode, number>,
  gap: number,
): Contour {
  const contourOfNode: Contour = { left: [-node.width / 2], right: [node.width / 2] };
  const [firstChild, ...otherChildren] = node.children;
  if (!firstChild) return contourOfNode;
  const contour = contours.get(firstChild);
  if (contour && otherChildren.length === 0) {
    // Extend the child's contour in place, because no other node needs it and a chain may be long.
    contour.left.unshift(-node.width / 2);
    contour.right.unshift(node.width / 2);
    return contour;
  }
  const combinedContour: Contour = { left: [], right: [] };
  const xs = node.children.map((child) => {
    const contour = contours.get(child) ?? contourOfNode;
    let x = 0;
    contour.left.forEach((left, level) => {
      const right = combinedContour.right[level];
      if (right !== undefined) x = Math.max(x, right + gap - left);
    });
    contour.left.forEach((left, level) => (combinedContour.left[level] ??= left + x));
    contour.right.forEach((right, level) => (combinedContour.right[level] = right + x));
    return x;
  });
  const center = ((xs[0] ?? 0) + (xs.at(-1) ?? 0)) / 2;
  node.children.forEach((child, i) => offsets.set(child, (xs[i] ?? 0) - center));
  for (const left of combinedContour.left) contourOfNode.left.push(left - center);
  for (const right of combinedContour.right) contourOfNode.right.push(right - center);
  return contourOfNode;
}

function listInPreorder(root: TreeNode): { node: TreeNode; depth: number; parent: TreeNode | null }[] {
  const entries: { node: TreeNode; depth: number; parent: TreeNode | null }[] = [];
  const stack = [{ node: root, depth: 0, parent: null as TreeNode | null }];
  for (let entry = stack.pop(); entry; entry = stack.pop()) {
    entries.push(entry);
    const { node, depth } = entry;
    for (const child of [...node.children].reverse()) stack.push({ node: child, depth: depth + 1, parent: node });
  }
  return entries;
}

function computeRowTops(entries: readonly { node: TreeNode; depth: number }[], gap: number): { top: number; height: number }[] {
  const rows: { top: number; height: number }[] = [];
  for (const { node, depth } of entries) {
    const row = (rows[depth] ??= { top: 0, height: 0 });
    row.height = Math.max(row.height, node.height);
  }
  let top = 0;
  for (const row of rows) {
    row.top = top;
    top += row.height + gap;
  }
  return rows;
}
