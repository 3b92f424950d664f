import type { AddPanelOptions, Direction, DockviewApi } from "dockview";
import { isFramed } from "../../dom";
import { strings } from "../../strings";
import type { PanelId } from "../panel";

interface Placement {
  /** Where the panel opens: next to the first of these panels that is open. */
  neighbors: readonly (readonly [PanelId, Direction])[];
  width?: number;
  height?: number;
  /** The width as a share of the dock's. */
  widthShare?: number;
  isInactive?: boolean;
}

/** To the right of the scene, above the other panels there. */
const RIGHT_NEIGHBORS: Placement["neighbors"] = [
  ["joints", "above"],
  ["diagnostics", "above"],
  ["scene", "right"],
];

/** Wide panels that are read line by line share one place below the scene. */
const BOTTOM_PANELS: readonly PanelId[] = ["terminal", "checks", "source", "diagram", "joint-table", "editing", "plot", "topics", "graph", "parameters", "log", "services", "publishers", "controllers", "trajectories"];
const BELOW_SCENE: Placement = { neighbors: [...BOTTOM_PANELS.map((id) => [id, "within"] as const), ["scene", "below"]], height: 300 };
/** The largest share of the dock's height that a panel requests. */
const MAX_HEIGHT_SHARE = 0.4;

/** Pixels: one line, without a tab. */
export const TIME_HEIGHT_PX = 32;

/** RViz's places: Displays on the left, the scene in the middle, everything else on the right. */
const PLACEMENTS: Readonly<Record<PanelId, Placement>> = {
  scene: { neighbors: [] },
  displays: { neighbors: [["links", "within"], ["scene", "left"]], width: 320 },
  views: {
    neighbors: [["tool-properties", "within"], ["selection", "within"], ...RIGHT_NEIGHBORS],
    width: 290,
    height: 290,
  },
  joints: {
    neighbors: [
      ["diagnostics", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
  },
  "tool-properties": {
    neighbors: [["views", "within"], ["selection", "within"], ...RIGHT_NEIGHBORS],
    width: 290,
    height: 290,
    isInactive: true,
  },
  selection: {
    neighbors: [["views", "within"], ["tool-properties", "within"], ...RIGHT_NEIGHBORS],
    width: 290,
    height: 290,
    isInactive: true,
  },
  time: { neighbors: [["scene", "below"]], height: TIME_HEIGHT_PX },
  transformation: {
    neighbors: [
      ["views", "within"],
      ["displays", "below"],
    ],
    width: 290,
  },
  help: {
    neighbors: [
      ["views", "within"],
      ["displays", "below"],
    ],
    width: 290,
  },
  "visual-tools": {
    neighbors: [
      ["views", "within"],
      ["displays", "below"],
    ],
    width: 290,
  },
  links: { neighbors: [["displays", "within"], ["scene", "left"]], width: 320, isInactive: true },
  comparison: { neighbors: [["displays", "within"], ["links", "within"], ["scene", "left"]], width: 320 },
  world: { neighbors: [["displays", "within"], ["links", "within"], ["scene", "left"]], width: 320 },
  lesson: { neighbors: [["displays", "within"], ["links", "within"], ["scene", "left"]], width: 320 },
  program: { neighbors: [["scene", "within"]] },
  turtlesim: { neighbors: [["scene", "within"]] },
  terminal: BELOW_SCENE,
  checks: BELOW_SCENE,
  source: BELOW_SCENE,
  diagram: BELOW_SCENE,
  "joint-table": BELOW_SCENE,
  editing: BELOW_SCENE,
  plot: BELOW_SCENE,
  topics: BELOW_SCENE,
  graph: BELOW_SCENE,
  parameters: BELOW_SCENE,
  log: BELOW_SCENE,
  services: BELOW_SCENE,
  publishers: BELOW_SCENE,
  controllers: BELOW_SCENE,
  trajectories: BELOW_SCENE,
  voice: {
    neighbors: [
      ["teleop", "within"],
      ["joints", "within"],
      ["diagnostics", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
  },
  teleop: {
    neighbors: [
      ["voice", "within"],
      ["joints", "within"],
      ["diagnostics", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
  },
  navigation: {
    neighbors: [
      ["teleop", "within"],
      ["voice", "within"],
      ["joints", "within"],
      ["diagnostics", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
  },
  "motion-planning": {
    neighbors: [
      ["diagnostics", "within"],
      ["joints", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 320,
  },
  diagnostics: {
    neighbors: [
      ["joints", "within"],
      ["views", "below"],
      ["scene", "right"],
    ],
    width: 290,
    isInactive: true,
  },
};

/** Pixels; in a window up to this width there is no room for panels beside the scene. */
const MAX_NARROW_WIDTH_PX = 900;
/** Pixels; from this width panels have their preferred widths, below it somewhat less. */
const MIN_ROOMY_WIDTH_PX = 1280;
const MIN_WIDTH_SHARE = 0.7;

/**
 * The panels that open in front where panels share a group: the displays, and the panel that the page was opened for.
 */
const FRONT_PANELS: readonly PanelId[] = ["displays", "world", "comparison", "lesson", "program", "turtlesim"];

/** A phone in landscape, where the status bar is hidden, too. */
const LOW_WINDOW_QUERY = "(max-height: 480px) and (max-width: 1000px) and (min-aspect-ratio: 3/2)";
/** The share of such a window that panels get, and their minimum and maximum width in pixels. */
const [LOW_WIDTH_SHARE, MIN_LOW_WIDTH_PX, MAX_LOW_WIDTH_PX] = [0.4, 270, 340];

/** The form of a window: "wide" has room beside the scene, "narrow" shows all panels below it, "low" all beside it. */
export type WindowForm = "wide" | "narrow" | "low";

export function formOf(api: DockviewApi): WindowForm {
  return matchMedia(LOW_WINDOW_QUERY).matches ? "low" : api.width <= MAX_NARROW_WIDTH_PX ? "narrow" : "wide";
}

/** In a narrow window the scene gets at least this share of the height, without the row of its tools. */
const MIN_SCENE_HEIGHT_SHARE = 0.5;
const TOOLS_HEIGHT_PX = 34;
/** Pixels; in a narrower window, the history, which arrives later, takes a second line of the footer. */
const MIN_ONE_LINE_FOOTER_WIDTH_PX = 640;
const FOOTER_LINE_HEIGHT_PX = 30;
const MAX_BELOW_SHARE = 0.45;

/** Returns the place of a panel on a phone: one group below the scene has all other panels; turtles replace the scene. */
function placeInNarrow(api: DockviewApi, id: PanelId): Placement {
  if (id === "scene" || id === "turtlesim") return PLACEMENTS[id];
  const otherPanels = (Object.keys(PLACEMENTS) as PanelId[]).filter((panel) => !["scene", "turtlesim", id].includes(panel));
  const neighbors: Placement["neighbors"] = [...otherPanels.map((panel) => [panel, "within"] as const), ["scene", "below"]];
  const reservedHeight = TOOLS_HEIGHT_PX + (window.innerWidth < MIN_ONE_LINE_FOOTER_WIDTH_PX && !isFramed() ? FOOTER_LINE_HEIGHT_PX : 0);
  const maxHeight = api.height - reservedHeight - MIN_SCENE_HEIGHT_SHARE * window.innerHeight;
  return { neighbors, height: Math.round(Math.min(maxHeight, api.height * MAX_BELOW_SHARE)), isInactive: !FRONT_PANELS.includes(id) };
}

/** Returns the place of a panel on a phone in landscape: one group beside the scene has all other panels. */
function placeInLow(api: DockviewApi, id: PanelId): Placement {
  const { neighbors: narrowNeighbors, isInactive = false } = placeInNarrow(api, id);
  const neighbors: Placement["neighbors"] = narrowNeighbors.map(([panel, direction]) => [panel, direction === "below" ? "right" : direction]);
  return { neighbors, isInactive, width: Math.round(Math.min(MAX_LOW_WIDTH_PX, Math.max(MIN_LOW_WIDTH_PX, api.width * LOW_WIDTH_SHARE))) };
}

/** The panels of the classroom. */
export const CLASSROOM_PANELS: readonly PanelId[] = ["scene", "lesson", "source", "checks", "terminal", "displays", "links", "diagnostics", "joints"];

const CLASSROOM_BOTTOM_HEIGHT_PX = 260;
const CLASSROOM_VIEW: Placement = { neighbors: [["joints", "within"], ["displays", "within"], ["scene", "below"]], height: CLASSROOM_BOTTOM_HEIGHT_PX, isInactive: true };

/** Where panels of the classroom open: the lesson on the left, the files in the middle, the robot on the right. */
const CLASSROOM_PLACEMENTS: Readonly<Partial<Record<PanelId, Placement>>> = {
  lesson: { neighbors: [["source", "left"], ["scene", "left"]], widthShare: 0.24 },
  source: { neighbors: [["scene", "left"]], widthShare: 0.4 },
  checks: { neighbors: [["lesson", "below"], ["terminal", "within"], ["scene", "left"]], height: CLASSROOM_BOTTOM_HEIGHT_PX },
  terminal: { neighbors: [["source", "below"], ["scene", "below"]], height: CLASSROOM_BOTTOM_HEIGHT_PX },
  displays: CLASSROOM_VIEW,
  links: CLASSROOM_VIEW,
  diagnostics: CLASSROOM_VIEW,
  joints: { ...CLASSROOM_VIEW, isInactive: false },
};

function placeInWide(api: DockviewApi, id: PanelId, isClassroom: boolean): Placement {
  const placement = { ...((isClassroom ? CLASSROOM_PLACEMENTS[id] : undefined) ?? PLACEMENTS[id]) };
  if (placement.width !== undefined) placement.width = Math.round(placement.width * Math.max(MIN_WIDTH_SHARE, Math.min(1, api.width / MIN_ROOMY_WIDTH_PX)));
  if (placement.widthShare !== undefined) placement.width = Math.round(placement.widthShare * api.width);
  if (placement.height !== undefined) placement.height = Math.min(placement.height, Math.round(api.height * MAX_HEIGHT_SHARE));
  return placement;
}

/** The order in which open panels move to their default places. */
export const DEFAULT_ORDER: readonly PanelId[] = ["scene", "time", "lesson", "program", "turtlesim", "displays", "links", "world", "comparison", "views", "tool-properties", "selection", "diagnostics", "joints", "teleop", "voice", "navigation", "motion-planning", "transformation", "help", "visual-tools", ...BOTTOM_PANELS];

/** Adds panels at their default places, or at those in the classroom. */
export function addPanels(api: DockviewApi, ids: readonly PanelId[], isClassroom = false): void {
  const placementOf = { wide: placeInWide, narrow: placeInNarrow, low: placeInLow }[formOf(api)];
  for (const id of ids) {
    const { neighbors, height, width, isInactive } = placementOf(api, id, isClassroom);
    const neighbor = neighbors.find(([panel]) => api.getPanel(panel) !== undefined);
    const options: AddPanelOptions = { id, component: id, tabComponent: id, title: strings.panels[id] };
    if (id === "program") options.renderer = "always"; // an iframe loads its page again after its element was removed
    if (width !== undefined) options.initialWidth = width;
    if (height !== undefined) options.initialHeight = height;
    // A panel that is alone in its group must be active, or the group stays empty.
    if (isInactive !== undefined && neighbor?.[1] === "within") options.inactive = isInactive;
    const position = neighbor && { referencePanel: neighbor[0], direction: neighbor[1] };
    api.addPanel(position ? { ...options, floating: false, position } : options);
  }
}
