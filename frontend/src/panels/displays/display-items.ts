import { iconNameOf, type IconName } from "../../icons";
import type { PropertyValue, StatusRow } from "../../protocol";
import { DRAWINGS } from "../../scene/displays/registry";
import type { DisplayState, ShownLevel } from "../../state/displays";
import type { Session } from "../../state/session";
import { shortNameOf } from "../../state/views/catalog";
import { strings } from "../../strings";
import { createPropertyItem } from "../../tree/property-item";
import type { TreeItem } from "../../tree/tree-item";
import { createDisplayRows } from "./robot-rows";

/** Returns the rows of the Displays panel, read from the session each time the tree is drawn. */
export function createDisplayItems(session: Session): TreeItem[] {
  const { displays } = session;
  if (!displays.isKnown) return [];
  const set = (id: string, value: PropertyValue): void => session.setProperty(id, value);
  return [
    {
      key: "#options",
      name: strings.tree.globalOptions,
      kind: "group",
      value: "",
      description: "",
      icon: "options",
      isStrong: true,
      isWide: true,
      isExpanded: true,
      children: () => displays.globalOptions.nodes.map((node) => createPropertyItem(node, set)),
    },
    createStatusItem("#status", strings.tree.globalStatus, displays.globalLevel, displays.globalStatus, true),
    ...displays.childrenOf(null).map((display) => createDisplayItem(session, display, set)),
  ];
}

function createDisplayItem(
  session: Session,
  display: DisplayState,
  set: (id: string, value: PropertyValue) => void,
): TreeItem {
  const hasDrawing = isDrawn(display);
  const status: TreeItem[] = [];
  if (display.isEnabled && display.status.length > 0) {
    const level = session.displays.levelOf(display);
    const name = `${strings.tree.status}: ${strings.tree.levels[level]}`;
    status.push(createStatusItem(`${display.id}#status`, name, level, display.status, false));
  }
  const createChildItems = (): TreeItem[] =>
    session.displays.childrenOf(display).map((child) => createDisplayItem(session, child, set));
  const addTopics = (item: TreeItem): TreeItem =>
    item.kind === "topic" ? { ...item, requestNames: (show) => offerTopics(session, display, item.name, show) } : item;
  return {
    key: display.id,
    name: display.name,
    kind: "bool",
    value: display.isChecked,
    description: describeDisplay(display, hasDrawing),
    icon: hasDrawing ? chooseIcon(display) : "unknown",
    isStrong: true,
    isMultiSelectable: true,
    isMuted: !hasDrawing || !display.isEnabled,
    ...(hasDrawing && display.isEnabled ? { level: findWorstLevel(session, display) } : {}),
    ...(display.problems.length > 0 ? { hint: [display.name, ...display.problems.map(formatStatusRow)].join("\n") } : {}),
    ...(hasDrawing ? {} : { badge: strings.tree.notDrawn }),
    isExpanded: display.isGroup || (display.isEnabled && isOnlyContent(session, display)),
    children: () => [...status, ...createDisplayRows(display, session, set).map(addTopics), ...createChildItems()],
    set: (value) => set(display.enabledId, value),
  };
}

/** The message type of robot descriptions. */
const DESCRIPTION_TYPE = "std_msgs/msg/String";

/** Asks the server for the topics that suit a row of a display, and passes them to `show`. */
function offerTopics(
  session: Session,
  display: DisplayState,
  row: string,
  show: (names: readonly string[]) => void,
): void {
  const { configuration } = session;
  const rowTopics = display.rows.find(row)?.topics;
  const words = rowTopics?.words ?? [];
  const matchesWords = (topic: string): boolean => words.length === 0 || words.some((word) => topic.toLowerCase().includes(word));
  const unsubscribe = configuration.choicesArrived.on(({ classes, topics }) => {
    unsubscribe();
    const messageTypes = rowTopics?.messages ?? classes.find((entry) => entry.cls === display.cls)?.messages ?? [];
    const messages = messageTypes.length > 0 ? messageTypes : [DESCRIPTION_TYPE];
    show(topics.filter(({ topic, message }) => messages.includes(message) && matchesWords(topic)).map(({ topic }) => topic));
  });
  configuration.requestChoices();
}

function isDrawn(display: DisplayState): boolean {
  return display.isGroup || (display.isSupported && DRAWINGS.has(display.drawing));
}

/** Returns a status row as one line. */
export function formatStatusRow({ name, text }: StatusRow): string {
  return `${name}: ${text}`;
}

/** Returns the icon of a display's class, or of the class that draws it. */
function chooseIcon({ cls, drawing }: DisplayState): IconName {
  const icon = iconNameOf(cls);
  return icon === "unknown" ? iconNameOf(drawing) : icon;
}

/** Returns a description of a display, in a sentence or two. */
export function describeDisplay(display: DisplayState, hasDrawing = isDrawn(display)): string {
  const name = shortNameOf(display.cls);
  const summary = (strings.displays.about as Readonly<Record<string, string | undefined>>)[name];
  const details = hasDrawing ? (summary ?? strings.tree.enabledHelp) : strings.tree.notDrawnHelp;
  return `${display.cls}. ${details}`;
}

/** Displays without messages; they are visible without their rows in the list. */
const CLASSES_WITHOUT_MESSAGES = ["Grid", "Axes", "TF", "Group"];

/**
 * Whether a RobotModel is the only content. It then starts expanded; otherwise its links would push other displays out
 * of sight.
 */
function isOnlyContent(session: Session, display: DisplayState): boolean {
  if (!display.cls.endsWith("/RobotModel")) return false;
  return session.displays.displays.every((otherDisplay) => otherDisplay === display || CLASSES_WITHOUT_MESSAGES.includes(shortNameOf(otherDisplay.cls)));
}

/** Returns the worst status of a display and, for a group, of its members. */
function findWorstLevel(session: Session, display: DisplayState): ShownLevel {
  const levels = [display, ...session.displays.displays.filter((child) => child.isWithin(display))]
    .filter((child) => child.isEnabled)
    .map((child) => child.level);
  return levels.includes("error") ? "error" : levels.includes("warn") ? "warn" : "ok";
}

function createStatusItem(
  key: string,
  name: string,
  level: ShownLevel,
  rows: readonly StatusRow[],
  isStrong: boolean,
): TreeItem {
  return {
    key,
    name: isStrong ? `${name}: ${strings.tree.levels[level]}` : name,
    kind: "group",
    value: "",
    description: "",
    level,
    showsLevelIcon: true,
    isStrong,
    isWide: true,
    isExpanded: level === "error",
    children: () =>
      sortWorstFirst(rows).map((row) => ({
        key: `${key}/${row.name}`,
        name: row.name,
        kind: "group",
        value: row.text,
        description: row.text,
        level: level === "loading" && row.level === "ok" ? level : row.level,
        showsLevelIcon: true,
      })),
  };
}

/** Sorts status rows by severity: among hundreds of links, the one that fails must be visible. */
function sortWorstFirst(rows: readonly StatusRow[]): StatusRow[] {
  const order: Readonly<Record<StatusRow["level"], number>> = { error: 0, warn: 1, ok: 2 };
  return [...rows].sort((a, b) => order[a.level] - order[b.level]);
}
