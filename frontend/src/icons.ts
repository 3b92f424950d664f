/** Our own icons, 16 x 16, drawn with lines in the colour of the text around them. */
const PATHS = {
  chevron: "M6 4l4 4-4 4",
  close: "M4.5 4.5l7 7M11.5 4.5l-7 7",
  check: "M3.5 8.5l3 3 6-7",
  warn: "M8 2.5l6 11H2zM8 6.5v3.5M8 12v.01",
  error: "M8 2a6 6 0 100 12A6 6 0 008 2zM5.8 5.8l4.4 4.4M10.2 5.8l-4.4 4.4",
  info: "M8 2a6 6 0 100 12A6 6 0 008 2zM8 7.2v4M8 4.9v.01",
  options: "M2 4.5h6M11 4.5h3M2 11.5h3M8 11.5h6M9.5 3v3M6.5 10v3",
  status: "M1.5 8.5h3l2-5 3 9 2-4h3",
  grid: "M2 3.5h12M2 8h12M2 12.5h12M3.5 2v12M8 2v12M12.5 2v12",
  robot: "M3 6h10v6.5H3zM8 6V3.5M8 3.5a.9.9 0 100-1.8.9.9 0 000 1.8M6 9v.01M10 9v.01M1.5 8.5v2M14.5 8.5v2M5 12.5V14M11 12.5V14",
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
  search: "M7 2.5a4.5 4.5 0 100 9 4.5 4.5 0 000-9zM10.3 10.3l3.4 3.4",
} as const;

export type IconName = keyof typeof PATHS;

const SVG = "http://www.w3.org/2000/svg";

export function icon(name: IconName, className = ""): SVGSVGElement {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("class", `icon ${className}`.trim());
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(SVG, "path");
  path.setAttribute("d", PATHS[name]);
  svg.append(path);
  return svg;
}

/** The sign of a status level or severity. */
export const LEVEL_ICONS = { ok: "check", warn: "warn", warning: "warn", error: "error", info: "info" } as const;
