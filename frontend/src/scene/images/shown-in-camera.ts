import type { DisplayState } from "../../state/displays";
import type { PropertyRows } from "../../state/properties";

const VISIBILITY = "Visibility";

/** Whether a Camera display's Visibility rows show a display: its own box, those of its groups, and the topmost one. */
export function isShownInCamera(rows: PropertyRows, display: DisplayState): boolean {
  const path = [display.name];
  for (let { group } = display; group; { group } = group) path.unshift(group.name);
  return [VISIBILITY, ...path].every((_, depth) => rows.bool(true, VISIBILITY, ...path.slice(0, depth)));
}
