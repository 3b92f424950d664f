import type { AddPanelOptions, Direction, DockviewApi } from "dockview-core/dist/esm";
import { strings } from "../strings";
import type { PanelId } from "./panel";

interface Home {
  /** Where the panel goes: beside the first of these that is open. */
  beside: readonly (readonly [PanelId, Direction])[];
  width?: number;
  height?: number;
  minimumHeight?: number;
  inactive?: boolean;
}

/** The live panels share a place below the scene. */
const LIVE_HOME: Home = {
  beside: [
    ["plot", "within"],
    ["topics", "within"],
    ["graph", "within"],
    ["parameters", "within"],
    ["log", "within"],
    ["source", "within"],
    ["scene", "below"],
  ],
  height: 300,
};

/** RViz's places: Displays left, the scene in the middle, everything else right. */
const HOMES: Readonly<Record<PanelId, Home>> = {
  scene: { beside: [] },
  displays: { beside: [["scene", "left"]], width: 320 },
  views: {
    beside: [
      ["joints", "above"],
      ["diagnostics", "above"],
      ["scene", "right"],
    ],
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
    beside: [
      ["views", "within"],
      ["selection", "within"],
      ["scene", "right"],
    ],
    width: 290,
    inactive: true,
  },
  selection: {
    beside: [
      ["views", "within"],
      ["tool-properties", "within"],
      ["scene", "right"],
    ],
    width: 290,
    inactive: true,
  },
  time: { beside: [["scene", "below"]], height: 68, minimumHeight: 60 },
  transformation: {
    beside: [
      ["views", "within"],
      ["displays", "below"],
    ],
    width: 290,
  },
  links: { beside: [["displays", "within"], ["scene", "left"]], width: 320, inactive: true },
  source: { beside: [["diagram", "within"], ["joint-table", "within"], ["scene", "below"]], height: 300 },
  diagram: { beside: [["source", "within"], ["joint-table", "within"], ["scene", "below"]], height: 300 },
  "joint-table": { beside: [["source", "within"], ["diagram", "within"], ["scene", "below"]], height: 300 },
  plot: LIVE_HOME,
  topics: LIVE_HOME,
  graph: LIVE_HOME,
  parameters: LIVE_HOME,
  log: LIVE_HOME,
  teleop: {
    beside: [
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

/** Adds panels at their usual places. */
export function addPanels(api: DockviewApi, ids: readonly PanelId[]): void {
  for (const id of ids) {
    const { beside, width, height, minimumHeight, inactive } = HOMES[id];
    const found = beside.find(([other]) => api.getPanel(other) !== undefined);
    const options: AddPanelOptions = { id, component: id, tabComponent: id, title: strings.panels[id] };
    if (width !== undefined) options.initialWidth = width;
    if (height !== undefined) options.initialHeight = height;
    if (minimumHeight !== undefined) options.minimumHeight = minimumHeight;
    // Alone in its group a panel must be active, or the group stays empty.
    if (inactive !== undefined && found?.[1] === "within") options.inactive = inactive;
    const position = found && { referencePanel: found[0], direction: found[1] };
    api.addPanel(position ? { ...options, floating: false, position } : options);
  }
}
