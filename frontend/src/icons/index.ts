import { DISPLAY_ICON_PATHS, type DisplayIcon } from "./displays";
import { MODELING_PATHS } from "./modeling";
import { SHELL_PATHS } from "./shell";

/** Our own icons, 16 x 16, drawn with lines in the current text color. */
const ICON_PATHS = {
  ...DISPLAY_ICON_PATHS,
  ...SHELL_PATHS,
  ...MODELING_PATHS,
  chevron: "M6 4l4 4-4 4",
  close: "M4.5 4.5l7 7M11.5 4.5l-7 7",
  check: "M3.5 8.5l3 3 6-7",
  warn: "M8 2.5l6 11H2zM8 6.5v3.5M8 12v.01",
  error: "M8 2a6 6 0 100 12A6 6 0 008 2zM5.8 5.8l4.4 4.4M10.2 5.8l-4.4 4.4",
  info: "M8 2a6 6 0 100 12A6 6 0 008 2zM8 7.2v4M8 4.9v.01",
  options: "M2 4.5h6M11 4.5h3M2 11.5h3M8 11.5h6M9.5 3v3M6.5 10v3",
  axes: "M6 10V2.5M4.3 4.2L6 2.5l1.7 1.7M6 10h7.5M11.8 8.3l1.7 1.7-1.7 1.7M6 10l-3.5 3.5M2.5 11.2v2.3h2.3",
  unknown: "M2.5 2.5h11v11h-11zM6.2 6.2a1.9 1.9 0 113 1.6c-.8.5-1.2.8-1.2 1.6M8 11.4v.01",
  displays: "M2 3h12M4.5 6.3H14M4.5 9.6H14M2 13h12M2 6.3v.01M2 9.6v.01",
  cube: "M8 1.8l5.5 3v6.4L8 14.2l-5.5-3V4.8zM2.5 4.8L8 8l5.5-3.2M8 8v6.2",
  camera: "M1.8 4.5h8.4v7H1.8zM10.2 7.2l4-2.2v6l-4-2.2",
  joints: "M4 12.2a1.8 1.8 0 100-3.6 1.8 1.8 0 000 3.6zM12 7.4a1.8 1.8 0 100-3.6 1.8 1.8 0 000 3.6zM5.6 9.5l4.8-2.9M12 7.4V13M2 14h4",
  link: "M6.8 9.2a2.6 2.6 0 003.7 0l2.2-2.2a2.6 2.6 0 00-3.7-3.7l-.8.8M9.2 6.8a2.6 2.6 0 00-3.7 0L3.3 9a2.6 2.6 0 003.7 3.7l.8-.8",
  file: "M4 1.8h5l3 3v9.4H4zM9 1.8v3h3M6 8h4M6 10.5h4",
  shuffle: "M1.8 4.5h2.7l6 7h3.2M1.8 11.5h2.7L6 9.8M9 6.2l1.5-1.7h3.2M12 2.8l1.8 1.7L12 6.2M12 9.8l1.8 1.7-1.8 1.7",
  center: "M8 1.8v3.4M8 10.8v3.4M1.8 8h3.4M10.8 8h3.4M8 6.2a1.8 1.8 0 100 3.6 1.8 1.8 0 000-3.6",
  reset: "M3 8a5 5 0 105-5H4.2M6.2 1L4 3l2.2 2.2",
  zero: "M8 2.5c-2.5 0-3.5 2.6-3.5 5.5s1 5.5 3.5 5.5 3.5-2.6 3.5-5.5-1-5.5-3.5-5.5z",
  panels: "M1.8 2.5h12.4v11H1.8zM5.8 2.5v11M10.6 2.5v11M10.6 8h3.6",
  language: "M8 2a6 6 0 100 12A6 6 0 008 2zM2.2 8h11.6M8 2c-4 4-4 8 0 12M8 2c4 4 4 8 0 12",
  copy: "M5.5 5.5h8v8h-8zM10.5 5.5v-3h-8v8h3",
  frame: "M8 14s4.5-4.2 4.5-7.6A4.5 4.5 0 003.5 6.4C3.5 9.8 8 14 8 14zM8 8a1.6 1.6 0 100-3.2A1.6 1.6 0 008 8z",
  plus: "M8 3.5v9M3.5 8h9",
  minus: "M3.5 8h9",
  keys: "M1.8 4h12.4v8H1.8zM4 6.5v.01M6.7 6.5v.01M9.3 6.5v.01M12 6.5v.01M4.5 9.5h7",
  interact: "M6.5 8.5V3.2a1.1 1.1 0 012.2 0v4l3.6.8c.8.2 1.2.8 1.1 1.6l-.6 3.9H7.2L4.3 10.3a1.1 1.1 0 011.6-1.5z",
  move: "M8 1.8v12.4M1.8 8h12.4M6.3 3.5L8 1.8l1.7 1.7M6.3 12.5L8 14.2l1.7-1.7M3.5 6.3L1.8 8l1.7 1.7M12.5 6.3L14.2 8l-1.7 1.7",
  select: "M2.5 5V2.5H5M11 2.5h2.5V5M13.5 11v2.5H11M5 13.5H2.5V11M6.5 6.5l5 2-2.2.9-.9 2.2z",
  focus: "M8 4.5a3.5 3.5 0 100 7 3.5 3.5 0 000-7zM8 1.5v3M8 11.5v3M1.5 8h3M11.5 8h3",
  measure: "M1.8 10.8l9-9 3.4 3.4-9 9zM4.5 8.1l1.5 1.5M7 5.6l2 2M9.5 3.1l1.5 1.5",
  estimate: "M8 9.5a2 2 0 100 4 2 2 0 000-4zM8 9.5V2.5M5.5 5L8 2.5 10.5 5",
  goal: "M3.5 14V2.5h8.5l-2 2.7 2 2.8H3.5",
  clock: "M8 2a6 6 0 100 12A6 6 0 008 2zM8 4.8V8l2.3 1.5",
  pause: "M5.5 3.5v9M10.5 3.5v9",
  plot: "M2 2v12h12M4 10.5l2.5-4 2.5 2.5L13.5 4",
  topics: "M2 4h3M7 4h7M2 8h3M7 8h7M2 12h3M7 12h7",
  graph: "M3.5 6.2a1.7 1.7 0 100-3.4 1.7 1.7 0 000 3.4M3.5 13.2a1.7 1.7 0 100-3.4 1.7 1.7 0 000 3.4M11.5 6.2h2v3.6h-4V6.2zM5.2 4.8l4.3 2.4M5.2 11.2l4.3-2.4",
  parameters: "M2 4h7M12 4h2M2 8h2M7 8h7M2 12h6M11 12h3M10.5 2.5v3M5.5 6.5v3M9.5 10.5v3",
  services: "M2 3.5h8v5H5.5L3.5 11V8.5H2zM12 6.5h2v5h-1.5V14l-2-2.5H7.5",
  publishers: "M8 9.2a1.2 1.2 0 100-2.4 1.2 1.2 0 000 2.4M5.3 10.7a3.8 3.8 0 010-5.4M10.7 5.3a3.8 3.8 0 010 5.4M3.3 12.7a6.6 6.6 0 010-9.4M12.7 3.3a6.6 6.6 0 010 9.4",
  controllers: "M4.5 4.5h7v7h-7zM6.5 2v2.5M9.5 2v2.5M6.5 11.5V14M9.5 11.5V14M2 6.5h2.5M2 9.5h2.5M11.5 6.5H14M11.5 9.5H14",
  trajectories: "M2 12.5c3 0 3-8 6-8s3 8 6 8M2 12.5v.01M14 12.5v.01M8 4.5v.01",
  log: "M2 3h12v10H2zM4.5 6l2 2-2 2M8.5 10.3h3",
  lesson: "M2 3.2c2.2-.8 4.3-.6 6 .8 1.7-1.4 3.8-1.6 6-.8v9.6c-2.2-.8-4.3-.6-6 .8-1.7-1.4-3.8-1.6-6-.8zM8 4v9.6",
  turtle: "M12 8a4.5 3.8 0 01-9 0 4.5 3.8 0 019 0zM12 8a1.3 1.3 0 102.2-1.1A1.3 1.3 0 0012 8zM10.3 4.9l1.4-1.6M10.3 11.1l1.4 1.6M4.7 4.9L3.3 3.3M4.7 11.1l-1.4 1.6M3 8H1.5M5.5 8h4M7.5 5.5v5",
  terminal: "M2 3h12v10H2zM4.5 6l2 2-2 2M8.5 10.3h3",
  navigation: "M8 1.8a4.6 4.6 0 014.6 4.6c0 3.2-4.6 7.8-4.6 7.8S3.4 9.6 3.4 6.4A4.6 4.6 0 018 1.8zM8 4.6a1.8 1.8 0 100 3.6 1.8 1.8 0 000-3.6",
  teleop: "M8 1.8l2 2.4H6zM8 14.2l2-2.4H6zM1.8 8l2.4-2v4zM14.2 8l-2.4-2v4zM8 6.4a1.6 1.6 0 100 3.2 1.6 1.6 0 000-3.2",
  microphone: "M8 1.8a2.2 2.2 0 00-2.2 2.2v3.6a2.2 2.2 0 004.4 0V4A2.2 2.2 0 008 1.8zM3.5 7.5a4.5 4.5 0 009 0M8 12v2.2M5.5 14.2h5",
  speech: "M2 3h12v7.5H7.5L4.5 13.2v-2.7H2z",
  download: "M8 2v7.5M4.8 6.5L8 9.7l3.2-3.2M2.5 13.5h11",
  clear: "M3 4.5h10M6.5 4.5V3h3v1.5M4.5 4.5l.6 9h5.8l.6-9",
  follow: "M8 2v8M4.8 7L8 10.2 11.2 7M3 13.5h10",
  search: "M7 2.5a4.5 4.5 0 100 9 4.5 4.5 0 000-9zM10.3 10.3l3.4 3.4",
  tree: "M3 2.5h4v2.6H3zM9 7h4v2.6H9zM9 11.4h4V14H9zM5 5.1v7.6h4M5 8.3h4",
  diagram: "M5.5 1.8h5v3h-5zM1.8 11.2h4.6v3H1.8zM9.6 11.2h4.6v3H9.6zM8 4.8v3.2M4.1 11.2V8h7.8v3.2",
  code: "M5.5 4.5L2 8l3.5 3.5M10.5 4.5L14 8l-3.5 3.5M9.2 2.8L6.8 13.2",
  table: "M2 3h12v10H2zM2 6.3h12M2 9.6h12M6 3v10",
  expand: "M4 6l4-4 4 4M4 10l4 4 4-4",
  collapse: "M4 2l4 4 4-4M4 14l4-4 4 4",
  fit: "M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10",
  more: "M3.5 8v.01M8 8v.01M12.5 8v.01",
  step: "M3 3l6 5-6 5zM12 3v10",
  stepBack: "M13 3L7 8l6 5zM4 3v10",
  loop: "M3.5 9V7.5a2.5 2.5 0 012.5-2.5h7M11 2.8L13.2 5 11 7.2M12.5 7v1.5A2.5 2.5 0 0110 11H3M5 8.8L2.8 11 5 13.2",
  play: "M5 3l7.5 5L5 13z",
  stop: "M4 4h8v8H4z",
  inspect: "M8 3.5C4.5 3.5 2 8 2 8s2.5 4.5 6 4.5S14 8 14 8s-2.5-4.5-6-4.5zM8 6.2a1.8 1.8 0 100 3.6 1.8 1.8 0 000-3.6z",
  image: "M2 3h12v10H2zM2 11l3.5-3.5 2.5 2.5 2.5-2.5L14 11M10.8 5.8v.01",
  handles: "M5 11V2.5M3.5 4.2L5 2.5l1.5 1.7M5 11h8.5M11.8 9.5l1.7 1.5-1.7 1.5M5 11l-3 3M9.5 7.5l4-4-1-1-4 4v1z",
  compare: "M2.5 4.5h6v7h-6zM7.5 2.5h6v7h-2.5M8.5 13.5l2 0M12 13.5h1.5v-1.5",
  hand: "M4.5 9V5a1 1 0 012 0V3a1 1 0 012 0v-.3a1 1 0 012 0V4a1 1 0 012 0v5.5c0 2.6-1.7 4.5-4.2 4.5-2 0-3-.8-4-2.6L2.6 8.6a1 1 0 011.7-1z",
} as const;

export type IconName = keyof typeof ICON_PATHS;

const SVG_NAMESPACE = "http://www.w3.org/2000/svg";

export function createIcon(name: IconName, className = ""): SVGSVGElement {
  const svg = document.createElementNS(SVG_NAMESPACE, "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("class", `icon ${className}`.trim());
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(SVG_NAMESPACE, "path");
  path.setAttribute("d", ICON_PATHS[name]);
  svg.append(path);
  return svg;
}

/** Returns the icon of a display class, such as `rviz_default_plugins/Grid` or `rviz_plugins::PoseHistory`. */
export function iconNameOf(cls: string): IconName {
  const name = cls.split(/\/|::/).pop() ?? cls;
  return name in DISPLAY_ICON_PATHS ? (name as DisplayIcon) : "unknown";
}

/** The icon of each status level and severity. */
export const LEVEL_ICONS = { ok: "check", loading: "clock", warn: "warn", warning: "warn", error: "error", info: "info" } as const;
