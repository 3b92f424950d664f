import type { IconName } from "../icons";
import type { PropertyValue, StatusLevel, StatusRow } from "../protocol.gen";
import type { DisplayState } from "../state/displays";
import type { PropertyNode } from "../state/properties";
import type { Session } from "../state/session";
import { DRAWINGS } from "../scene/displays/registry";
import { strings } from "../strings";
import type { TreeItem } from "../tree/tree-item";

const ICONS: Readonly<Record<string, IconName>> = {
  Grid: "grid",
  RobotModel: "robot",
  TF: "axes",
};

/** The rows of the Displays panel, read from the session each time the tree is drawn. */
export function displayItems(session: Session): TreeItem[] {
  const { displays } = session;
  const set = (id: string, value: PropertyValue): void => session.setProperty(id, value);
  return [
    {
      key: "#options",
      name: strings.tree.globalOptions,
      kind: "group",
      value: "",
      description: "",
      icon: "options",
      strong: true,
      expanded: true,
      children: () => displays.globalOptions.nodes.map((node) => propertyItem(node, set)),
    },
    statusItem("#status", strings.tree.globalStatus, displays.globalLevel, displays.globalStatus, true),
    ...displays.displays.map((display) => displayItem(display, set)),
  ];
}

/** The keys of a link's row and of the rows above it, from the top; null when it has no row. */
export function linkPath(display: DisplayState, link: string): string[] | null {
  const top = display.rows.find("Links");
  const below = top && pathTo(top, link);
  return below ? [display.id, ...below] : null;
}

/** The display and link whose row has this key. */
export function linkOfKey(session: Session, key: string): { display: DisplayState; link: string } | null {
  for (const display of session.displays.displays) {
    const robot = session.robots.get(display.id);
    if (!robot) continue;
    for (const node of display.rows.find("Links")?.walk() ?? []) {
      if (node.id === key && isLink(node)) return { display, link: node.name };
    }
  }
  return null;
}

function displayItem(display: DisplayState, set: (id: string, value: PropertyValue) => void): TreeItem {
  const drawn = display.supported && DRAWINGS.has(display.cls);
  const short = display.cls.split("/").pop() ?? display.cls;
  const status: TreeItem[] = [];
  if (display.enabled && display.status.length > 0) {
    const name = `${strings.tree.status}: ${strings.tree.levels[display.level]}`;
    status.push(statusItem(`${display.id}#status`, name, display.level, display.status, false));
  }
  return {
    key: display.id,
    name: display.name,
    kind: "bool",
    value: display.enabled,
    description: drawn ? `${display.cls}. ${strings.tree.enabledHelp}` : `${display.cls}. ${strings.tree.notDrawnHelp}`,
    icon: drawn ? (ICONS[short] ?? "unknown") : "unknown",
    strong: true,
    muted: !drawn || !display.enabled,
    ...(drawn && display.enabled ? { level: display.level } : {}),
    ...(drawn ? {} : { badge: strings.tree.notDrawn }),
    expanded: short === "RobotModel" && display.enabled,
    children: () => [...status, ...display.rows.nodes.map((node) => propertyItem(node, set))],
    set: (value) => set(display.enabledId, value),
  };
}

function statusItem(
  key: string,
  name: string,
  level: StatusLevel,
  rows: readonly StatusRow[],
  strong: boolean,
): TreeItem {
  return {
    key,
    name: strong ? `${name}: ${strings.tree.levels[level]}` : name,
    kind: "group",
    value: "",
    description: "",
    level,
    showLevelIcon: true,
    strong,
    expanded: level === "error",
    children: () =>
      worstFirst(rows).map((row) => ({
        key: `${key}/${row.name}`,
        name: row.name,
        kind: "group",
        value: row.text,
        description: row.text,
        level: row.level,
        showLevelIcon: true,
      })),
  };
}

/** Among hundreds of links the one that fails must be seen. */
function worstFirst(rows: readonly StatusRow[]): StatusRow[] {
  const order: Readonly<Record<StatusLevel, number>> = { error: 0, warn: 1, ok: 2 };
  return [...rows].sort((a, b) => order[a.level] - order[b.level]);
}

function propertyItem(node: PropertyNode, set: (id: string, value: PropertyValue) => void): TreeItem {
  return {
    key: node.id,
    name: node.name,
    kind: node.kind,
    value: node.value,
    description: node.description,
    options: node.options,
    minimum: node.minimum,
    maximum: node.maximum,
    readOnly: node.readOnly,
    expanded: node.expanded,
    ...(node.children.length > 0 ? { children: () => node.children.map((child) => propertyItem(child, set)) } : {}),
    ...(node.readOnly ? {} : { set: (value: PropertyValue) => set(node.id, value) }),
  };
}

/** Only links have a trail, however the tree below Links is arranged. */
function isLink(node: PropertyNode): boolean {
  return node.children.some((child) => child.name === "Show Trail");
}

function pathTo(node: PropertyNode, link: string): string[] | null {
  if (node.name === link && isLink(node)) return [node.id];
  for (const child of node.children) {
    const below = pathTo(child, link);
    if (below) return [node.id, ...below];
  }
  return null;
}
