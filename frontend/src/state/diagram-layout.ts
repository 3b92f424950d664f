import type { JointDetails } from "../protocol";
import type { DescriptionModel, ElementName } from "./description-model";
import { formatGeneral } from "./number-text";
import { layOutTree, type TreeNode } from "./tidy-tree";

/** A box (link) or ellipse (joint) of the diagram; x and y of its center, px. */
export interface DiagramNode {
  readonly element: ElementName;
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
  /** The text at the edge above a joint: its origin in the parent's frame. */
  readonly origin: readonly string[];
  /** The node at the start of the edge to this one. */
  readonly parent: DiagramNode | null;
}

export interface Diagram {
  readonly nodes: readonly DiagramNode[];
  readonly width: number;
  readonly height: number;
}

const BOX_HEIGHT_PX = 26;
const ELLIPSE_HEIGHT_PX = 30;
const SIBLING_GAP_PX = 22;
const LEVEL_GAP_PX = 26;
const ORIGIN_HEIGHT_PX = 34;

interface SizedNode extends TreeNode {
  readonly element: ElementName;
  readonly boxWidth: number;
  readonly boxHeight: number;
  readonly origin: readonly string[];
  readonly children: readonly SizedNode[];
}

/**
 * Lays out the structure like urdf_to_graphviz: links as boxes, joints as ellipses between them, origins at the edges.
 *
 * @param measure - returns the width of a text, px.
 */
export function layOutDiagram(model: DescriptionModel, showsOrigins: boolean, measure: (text: string) => number): Diagram {
  const sizeNode = (kind: ElementName["kind"], name: string, origin: readonly string[], children: readonly SizedNode[]): SizedNode => {
    const boxWidth = measure(name) + (kind === "link" ? 20 : 34);
    const boxHeight = kind === "link" ? BOX_HEIGHT_PX : ELLIPSE_HEIGHT_PX;
    const width = Math.max(boxWidth, ...origin.map(measure));
    const height = boxHeight + (origin.length > 0 ? ORIGIN_HEIGHT_PX : 0);
    const element = { display: model.display, kind, name };
    return { id: `${kind} ${name}`, element, width, height, boxWidth, boxHeight, origin, children };
  };
  const tree = layOutTree(buildTree(model, showsOrigins, sizeNode), SIBLING_GAP_PX, LEVEL_GAP_PX);
  const diagramNodes = new Map<TreeNode, DiagramNode>();
  const nodes = tree.nodes.map(({ node, x, y, parent }) => {
    const { element, boxWidth, boxHeight, origin } = node as SizedNode;
    const parentNode = (parent && diagramNodes.get(parent.node)) ?? null;
    const originOffset = origin.length > 0 ? ORIGIN_HEIGHT_PX / 2 : 0;
    const diagramNode = { element, x, y: y + originOffset, width: boxWidth, height: boxHeight, origin, parent: parentNode };
    diagramNodes.set(node, diagramNode);
    return diagramNode;
  });
  return { nodes, width: tree.width, height: tree.height };
}

/** Builds the tree from the leaves up, without recursion, because descriptions may be chains of thousands of links. */
function buildTree(
  model: DescriptionModel,
  showsOrigins: boolean,
  sizeNode: (kind: ElementName["kind"], name: string, origin: readonly string[], children: readonly SizedNode[]) => SizedNode,
): SizedNode {
  const linksTopDown: string[] = [];
  const visited = new Set<string>();
  const stack = [model.description.root];
  for (let link = stack.pop(); link !== undefined; link = stack.pop()) {
    if (visited.has(link)) continue;
    visited.add(link);
    linksTopDown.push(link);
    for (const joint of model.childJointsOf(link)) stack.push(joint.child);
  }
  const sizedNodes = new Map<string, SizedNode>();
  for (const link of linksTopDown.reverse()) {
    const joints = model.childJointsOf(link).flatMap((joint) => {
      const child = sizedNodes.get(joint.child);
      return child ? [sizeNode("joint", joint.name, showsOrigins ? formatOrigin(joint) : [], [child])] : [];
    });
    sizedNodes.set(link, sizeNode("link", link, [], joints));
  }
  return sizedNodes.get(model.description.root) ?? sizeNode("link", model.description.root, [], []);
}

/**
 * Returns the text of an origin as urdf_to_graphviz writes it: meters, and radians converted through the quaternion.
 */
function formatOrigin({ xyz, rpy }: Pick<JointDetails, "xyz" | "rpy">): [string, string] {
  return [`xyz: ${xyz.map(formatGeneral).join(" ")}`, `rpy: ${rpy.map(formatGeneral).join(" ")}`];
}
