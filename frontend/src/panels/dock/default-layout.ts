import type { AddPanelOptions, Direction, DockviewApi } from "dockview";
import { isFramed } from "../../dom";
import { strings } from "../../strings";
import type { PanelId } from "../panel";

interface Placement {
  /** Where the panel opens: next to the first of these panels that is open. */
  beside: readonly (readonly [PanelId, Direction])[];
  width?: number;
  height?: number;
  /** The width as a share of the dock's. */
  share?: number;
  inactive?: boolean;
}

/** Right of the scene, above the panels there. */
const RIGHT: Placement["beside"] = [
  ["joints", "above"],
  ["diagnostics", "above"],
  ["scene", "right"],
];

/** Wide panels that are read line by line share one place below the scene. */
const BOTTOM: readonly PanelId[] = ["terminal", "checks", "source", "diagram", "joint-table", "editing", "plot", "topics", "graph", "parameters", "log"];
const BELOW: Placement = { beside: [...BOTTOM.map((id) => [id, "within"] as const), ["scene", "below"]], height: 300 };
/** The largest share of the dock's height that a panel requests. */
const MAX_HEIGHT_SHARE = 0.4;

/** Pixels: one line, without a tab. */
export const TIME_HEIGHT = 32;

/** RViz's places: Displays on the left, the scene in the middle, everything else on the right. */
const PLACEMENTS: Readonly<Record<PanelId, Placement>> = {
  scene: { beside: [] },
  displays: { beside: [["links", "within"], ["scene", "left"]], width: 320 },
  views: {
    beside: [["tool-properties", "within"], ["selection", "within"], ...RIGHT],
    width: 290,
    height: 290,
  },
  joints: {
    beside: [
      ["diagnostics", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
  },
  "tool-properties": {
    beside: [["views", "within"], ["selection", "within"], ...RIGHT],
    width: 290,
    height: 290,
    inactive: true,
  },
  selection: {
    beside: [["views", "within"], ["tool-properties", "within"], ...RIGHT],
    width: 290,
    height: 290,
    inactive: true,
  },
  time: { beside: [["scene", "below"]], height: TIME_HEIGHT },
  transformation: {
    beside: [
      ["views", "within"],
      ["displays", "below"],
    ],
    width: 290,
  },
  links: { beside: [["displays", "within"], ["scene", "left"]], width: 320, inactive: true },
  comparison: { beside: [["displays", "within"], ["links", "within"], ["scene", "left"]], width: 320 },
  world: { beside: [["displays", "within"], ["links", "within"], ["scene", "left"]], width: 320 },
  lesson: { beside: [["displays", "within"], ["links", "within"], ["scene", "left"]], width: 320 },
  program: { beside: [["scene", "within"]] },
  terminal: BELOW,
  checks: BELOW,
  source: BELOW,
  diagram: BELOW,
  "joint-table": BELOW,
  editing: BELOW,
  plot: BELOW,
  topics: BELOW,
  graph: BELOW,
  parameters: BELOW,
  log: BELOW,
  voice: {
    beside: [
      ["teleop", "within"],
      ["joints", "within"],
      ["diagnostics", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
  },
  teleop: {
    beside: [
      ["voice", "within"],
      ["joints", "within"],
      ["diagnostics", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
  },
  navigation: {
    beside: [
      ["teleop", "within"],
      ["voice", "within"],
      ["joints", "within"],
      ["diagnostics", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
  },
  diagnostics: {
    beside: [
      ["joints", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
    inactive: true,
  },
};

/** Pixels; in a window up to this width there is no room for panels beside the scene. */
const NARROW = 900;
/** Pixels; from this width panels have their preferred widths, below it somewhat less. */
const ROOMY = 1280;
const MIN_WIDTH_SHARE = 0.7;

/**
 * In windows where panels share a group, those that open in front: the displays, and the panel that the page was opened
 * for.
 */
const IN_FRONT: readonly PanelId[] = ["displays", "world", "comparison", "lesson", "program"];

/** A phone in landscape, where the status bar is hidden, too. */
const LOW = "(max-height: 480px) and (max-width: 1000px) and (min-aspect-ratio: 3/2)";
/** The share of such a window that panels get, and their minimum and maximum width in pixels. */
const [LOW_SHARE, LOW_LEAST, LOW_MOST] = [0.4, 270, 340];

/** The form of a window: "wide" has room beside the scene, "narrow" shows all panels below it, "low" all beside it. */
export type Form = "wide" | "narrow" | "low";

export function formOf(api: DockviewApi): Form {
  return matchMedia(LOW).matches ? "low" : api.width <= NARROW ? "narrow" : "wide";
}

/** In a narrow window the scene gets at least this share of the height, without the row of its tools. */
const SCENE_SHARE = 0.5;
const TOOLS_HEIGHT = 34;
/** Pixels; in a narrower window the history, which arrives later, is a row of its own in the foot. */
const FOOT_WRAPS = 640;
const FOOT_LINE = 30;
const MAX_BELOW_SHARE = 0.45;

/** Returns the place of a panel on a phone: one group below the scene has all other panels. */
function narrowHome(api: DockviewApi, id: PanelId): Placement {
  if (id === "scene") return PLACEMENTS.scene;
  const others = (Object.keys(PLACEMENTS) as PanelId[]).filter((each) => each !== "scene" && each !== id);
  const beside: Placement["beside"] = [...others.map((other) => [other, "within"] as const), ["scene", "below"]];
  const lines = TOOLS_HEIGHT + (window.innerWidth < FOOT_WRAPS && !isFramed() ? FOOT_LINE : 0);
  const left = api.height - lines - SCENE_SHARE * window.innerHeight;
  return { beside, height: Math.round(Math.min(left, api.height * MAX_BELOW_SHARE)), inactive: !IN_FRONT.includes(id) };
}

/** Returns the place of a panel on a phone in landscape: one group beside the scene has all other panels. */
function lowHome(api: DockviewApi, id: PanelId): Placement {
  const { beside: near, inactive = false } = narrowHome(api, id);
  const beside: Placement["beside"] = near.map(([other, where]) => [other, where === "below" ? "right" : where]);
  return { beside, inactive, width: Math.round(Math.min(LOW_MOST, Math.max(LOW_LEAST, api.width * LOW_SHARE))) };
}

/** The panels of the classroom. */
export const CLASSROOM_PANELS: readonly PanelId[] = ["scene", "lesson", "source", "checks", "terminal", "displays", "links", "diagnostics", "joints"];

const CLASSROOM_LOWER = 260;
const CLASSROOM_VIEW: Placement = { beside: [["joints", "within"], ["displays", "within"], ["scene", "below"]], height: CLASSROOM_LOWER, inactive: true };

/** Where panels of the classroom open: the lesson on the left, the files in the middle, the robot on the right. */
const CLASSROOM: Readonly<Partial<Record<PanelId, Placement>>> = {
  lesson: { beside: [["source", "left"], ["scene", "left"]], share: 0.24 },
  source: { beside: [["scene", "left"]], share: 0.4 },
  checks: { beside: [["lesson", "below"], ["terminal", "within"], ["scene", "left"]], height: CLASSROOM_LOWER },
  terminal: { beside: [["source", "below"], ["scene", "below"]], height: CLASSROOM_LOWER },
  displays: CLASSROOM_VIEW,
  links: CLASSROOM_VIEW,
  diagnostics: CLASSROOM_VIEW,
  joints: { ...CLASSROOM_VIEW, inactive: false },
};

function wideHome(api: DockviewApi, id: PanelId, isClassroom: boolean): Placement {
  const home = { ...((isClassroom ? CLASSROOM[id] : undefined) ?? PLACEMENTS[id]) };
  if (home.width !== undefined) home.width = Math.round(home.width * Math.max(MIN_WIDTH_SHARE, Math.min(1, api.width / ROOMY)));
  if (home.share !== undefined) home.width = Math.round(home.share * api.width);
  if (home.height !== undefined) home.height = Math.min(home.height, Math.round(api.height * MAX_HEIGHT_SHARE));
  return home;
}

/** The order in which open panels move to their default places. */
export const DEFAULT_ORDER: readonly PanelId[] = ["scene", "time", "lesson", "program", "displays", "links", "world", "comparison", "views", "tool-properties", "selection", "diagnostics", "joints", "teleop", "voice", "navigation", "transformation", ...BOTTOM];

/** Adds panels at their default places, or at those in the classroom. */
export function addPanels(api: DockviewApi, ids: readonly PanelId[], isClassroom = false): void {
  const homeIn = { wide: wideHome, narrow: narrowHome, low: lowHome }[formOf(api)];
  for (const id of ids) {
    const { beside, height, width, inactive } = homeIn(api, id, isClassroom);
    const found = beside.find(([other]) => api.getPanel(other) !== undefined);
    const options: AddPanelOptions = { id, component: id, tabComponent: id, title: strings.panels[id] };
    if (id === "program") options.renderer = "always"; // a frame whose element is removed loads its page again
    if (width !== undefined) options.initialWidth = width;
    if (height !== undefined) options.initialHeight = height;
    // A panel that is alone in its group must be active, or the group stays empty.
    if (inactive !== undefined && found?.[1] === "within") options.inactive = inactive;
    const position = found && { referencePanel: found[0], direction: found[1] };
    api.addPanel(position ? { ...options, floating: false, position } : options);
  }
}
