import { FIELD_OF_VIEW, type ViewSize } from "./camera";
import { OrbitController } from "./orbit";
import { add, dot, scale, subtract, type Vector } from "./vector";
import { vectorValues, type ViewValues } from "./view-controller";

/** A box along the axes of the fixed frame: its lowest and highest corner, m. */
export interface Span {
  readonly min: Vector;
  readonly max: Vector;
}

/** Room around what is looked at. */
const MARGIN = 1.2;
const orbit = new OrbitController();

/** The values of an Orbit that shows all of a box from where it looks, as large as a canvas of this size has room. */
export function fitted(values: ViewValues, { min, max }: Span, { width, height }: ViewSize): ViewValues {
  const middle = scale(add(min, max, 1), 0.5);
  const { right, up, back } = orbit.camera(values);
  const tangent = Math.tan(FIELD_OF_VIEW / 2) / MARGIN;
  let distance = 0;
  for (const x of [min[0], max[0]]) {
    for (const y of [min[1], max[1]]) {
      for (const z of [min[2], max[2]]) {
        const corner = subtract([x, y, z], middle);
        const aside = Math.max(Math.abs(dot(corner, up)), (Math.abs(dot(corner, right)) * height) / width);
        distance = Math.max(distance, dot(corner, back) + aside / tangent);
      }
    }
  }
  return { ...vectorValues("Focal Point", middle), ...(distance > 0 ? { Distance: distance } : {}) };
}
