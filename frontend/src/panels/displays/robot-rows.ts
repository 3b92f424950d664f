import type { JointScene, PropertyValue, RobotScene } from "../../protocol";
import type { DisplayState } from "../../state/displays";
import type { PropertyNode } from "../../state/properties";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { createPropertyItem } from "../../tree/property-item";
import type { TreeItem } from "../../tree/tree-item";
import { createDetailRows } from "./detail-rows";

type SetValue = (id: string, value: PropertyValue) => void;

const STYLE_ROW = "Link Tree Style";
const EXPAND_TREE_ROW = "Expand Tree";
const EXPAND_LINK_DETAILS_ROW = "Expand Link Details";
const EXPAND_JOINT_DETAILS_ROW = "Expand Joint Details";

/** RViz's Link Tree Styles: the title of the top row, whether it is a tree, and whether it lists links and joints. */
const STYLES: Readonly<Record<string, { title: string; isTree: boolean; hasLinks: boolean; hasJoints: boolean }>> = {
  "Links in Alphabetic Order": { title: "Links", isTree: false, hasLinks: true, hasJoints: false },
  "Joints in Alphabetic Order": { title: "Joints", isTree: false, hasLinks: false, hasJoints: true },
  "Tree of links": { title: "Link Tree", isTree: true, hasLinks: true, hasJoints: false },
  "Tree of links and joints": { title: "Link/Joint Tree", isTree: true, hasLinks: true, hasJoints: true },
};

/**
 * Returns the rows of a display. Most are shown as the server sent them; the links and joints of a RobotModel arrive as
 * two lists and are arranged by its Link Tree Style.
 */
export function createDisplayRows(display: DisplayState, session: Session, set: SetValue): TreeItem[] {
  const robot = session.robots.get(display.id);
  return display.rows.nodes.flatMap((node) => {
    if (!robot || !isRobotRow(node)) return [createRowWithDetails(node, display, session, set)];
    return node.name === "Links" ? [new RobotTree(display, session, robot, set).topRow] : [];
  });
}

/** Returns the keys of a link's row, or of its joint's row, and of the rows above; null if it has none. */
export function findLinkRowPath(display: DisplayState, session: Session, link: string): string[] | null {
  const robot = session.robots.get(display.id);
  if (!robot || !display.rows.find("Links")) return null;
  return new RobotTree(display, session, robot, () => undefined).findPath(link);
}

/** Returns the display and link whose row has this key. */
export function findLinkOfRow(session: Session, key: string): { display: DisplayState; link: string } | null {
  for (const display of session.displays.displays) {
    const node = display.rows.find("Links")?.children.find((child) => child.id === key && child.details === "link");
    if (node) return { display, link: node.name };
  }
  return null;
}

/** Whether editing this row opens or closes the rows of links and joints. */
export function isExpansion(node: PropertyNode): boolean {
  return [STYLE_ROW, EXPAND_TREE_ROW, EXPAND_LINK_DETAILS_ROW, EXPAND_JOINT_DETAILS_ROW].includes(node.name) && node.id.includes("/Links/");
}

function isRobotRow(node: PropertyNode): boolean {
  return (node.name === "Links" || node.name === "Joints") && node.kind === "group";
}

function createRowWithDetails(node: PropertyNode, display: DisplayState, session: Session, set: SetValue): TreeItem {
  if (node.children.length === 0 && node.details === null) return createPropertyItem(node, set);
  return {
    ...createPropertyItem(node, set),
    children: () => [
      ...node.children.map((child) => createRowWithDetails(child, display, session, set)),
      ...createDetailRows(node, display, session),
    ],
  };
}

/** The rows of one robot, arranged by its style. */
class RobotTree {
  private readonly options: PropertyNode | undefined;
  private readonly style: { title: string; isTree: boolean; hasLinks: boolean; hasJoints: boolean };
  private readonly links: ReadonlyMap<string, PropertyNode>;
  private readonly joints: ReadonlyMap<string, PropertyNode>;
  private readonly jointsByParent = new Map<string, JointScene[]>();

  constructor(
    private readonly display: DisplayState,
    private readonly session: Session,
    private readonly robot: RobotScene,
    private readonly set: SetValue,
  ) {
    this.options = display.rows.find("Links");
    const defaultStyle = { title: "Links", isTree: false, hasLinks: true, hasJoints: false };
    this.style = STYLES[display.rows.text("", "Links", STYLE_ROW)] ?? defaultStyle;
    const mapNodes = (groupName: string): ReadonlyMap<string, PropertyNode> =>
      new Map(display.rows.find(groupName)?.children.filter((row) => row.details).map((row) => [row.name, row]));
    this.links = mapNodes("Links");
    this.joints = mapNodes("Joints");
    for (const joint of robot.joints) {
      const siblings = this.jointsByParent.get(joint.parent);
      if (siblings) siblings.push(joint);
      else this.jointsByParent.set(joint.parent, [joint]);
    }
  }

  /** The top row. */
  get topRow(): TreeItem {
    const { options, style } = this;
    const isShown = (node: PropertyNode): boolean =>
      node.details === null &&
      (node.name !== EXPAND_TREE_ROW || style.isTree) &&
      (node.name !== EXPAND_LINK_DETAILS_ROW || style.hasLinks) &&
      (node.name !== EXPAND_JOINT_DETAILS_ROW || style.hasJoints);
    return {
      key: options?.id ?? "",
      name: style.title,
      kind: "group",
      value: null,
      description: options?.description ?? "",
      children: () => [
        ...(options?.children.filter(isShown).map((node) => createPropertyItem(node, this.set)) ?? []),
        ...this.createRows(),
      ],
    };
  }

  findPath(link: string): string[] | null {
    const parents = new Map(this.robot.joints.map((joint) => [joint.child, joint]));
    const path: string[] = [];
    for (let name: string | undefined = link; name !== undefined; ) {
      const joint: JointScene | undefined = parents.get(name);
      const rows = [this.style.hasJoints && joint ? this.joints.get(joint.name) : undefined];
      if (this.style.hasLinks) rows.push(this.links.get(name));
      path.unshift(...rows.flatMap((row) => (row ? [row.id] : [])));
      name = this.style.isTree ? joint?.parent : undefined;
    }
    return path.length > 0 && this.options ? [this.display.id, this.options.id, ...path] : null;
  }

  private createRows(): TreeItem[] {
    if (!this.style.isTree) {
      const nodes = this.style.hasLinks ? this.links : this.joints;
      return [...nodes.values()].map((node) => this.createRow(node, () => []));
    }
    const children = new Set(this.robot.joints.map((joint) => joint.child));
    return this.robot.links.filter((link) => !children.has(link.name)).flatMap((link) => this.createLinkRows(link.name));
  }

  private createLinkRows(link: string): TreeItem[] {
    const node = this.links.get(link);
    const createChildRows = (): TreeItem[] => (this.jointsByParent.get(link) ?? []).flatMap((joint) => this.createJointRows(joint));
    return node ? [this.createRow(node, createChildRows)] : createChildRows();
  }

  private createJointRows(joint: JointScene): TreeItem[] {
    const node = this.style.hasJoints ? this.joints.get(joint.name) : undefined;
    if (!node) return this.createLinkRows(joint.child);
    return [this.createRow(node, () => this.createLinkRows(joint.child))];
  }

  /** Returns the row of a link or joint. In a tree, its details are below a row of their own. */
  private createRow(node: PropertyNode, createChildRows: () => TreeItem[]): TreeItem {
    const { rows } = this.display;
    const { isTree } = this.style;
    const isOpen = rows.bool(false, "Links", node.details === "link" ? EXPAND_LINK_DETAILS_ROW : EXPAND_JOINT_DETAILS_ROW);
    const createDetails = (): TreeItem[] => [
      ...node.children.map((child) => createPropertyItem(child, this.set)),
      ...createDetailRows(node, this.display, this.session),
    ];
    const detailsRow: TreeItem = {
      key: `${node.id}#Details`,
      name: "Details",
      kind: "group",
      value: null,
      description: strings.details.Details,
      isExpanded: isOpen,
      children: createDetails,
    };
    return {
      ...createPropertyItem(node, this.set),
      isExpanded: isTree ? rows.bool(false, "Links", EXPAND_TREE_ROW) : isOpen,
      children: () => (isTree ? [detailsRow, ...createChildRows()] : createDetails()),
    };
  }
}
