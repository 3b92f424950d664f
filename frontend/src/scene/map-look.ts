import { Box3 } from "three";
import type { ViewState } from "../state/view";
import type { Drawing } from "./displays/drawing";
import { MapDrawing } from "./displays/map";
import { boundsOf } from "./initial-view";
import type { UncoveredArea } from "./uncovered-area";

/** Selects the windows of phones. A scale from a file, in pixels per meter, would cut off most of a map there. */
const PHONE_QUERY = "(max-width: 900px), (max-height: 480px)";

/**
 * On a phone, fits all maps into a camera above them until the user moves it; repeats this when maps grow or the phone
 * is rotated.
 */
export function fitMaps(drawings: Iterable<readonly [string, Drawing]>, view: ViewState, area: UncoveredArea): void {
  if (!matchMedia(PHONE_QUERY).matches) return;
  const maps = [...drawings].flatMap(([, drawing]) => (drawing instanceof MapDrawing ? [drawing] : []));
  if (maps.length === 0) return;
  const [width, height] = [window.innerWidth, window.innerHeight];
  const key = [...maps.map((map) => map.size), `${width} x ${height}`].join(";");
  if (!view.awaitsMapFit(key)) return;
  const bounds = boundsOf(maps.reduce((sum, map) => sum.union(map.computeBounds()), new Box3()));
  if (bounds) view.fitMap(bounds, area.centerView(), key);
}
