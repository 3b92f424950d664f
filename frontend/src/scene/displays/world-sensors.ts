import { Group, Matrix4, Quaternion, Vector3 } from "three";
import type { CameraScene, LidarScene, WorldRays, WorldScene } from "../../protocol";
import type { PropertyRows } from "../../state/properties";
import { ThinLines } from "../objects/thin-lines";

type Color = readonly [number, number, number, number];

/**
 * Colors (r g b a, 0 to 1) of rays: at the sensor, where rays are dense; at a hit; at the end of a ray without a hit.
 */
const BEGIN: Color = [0.25, 0.6, 1, 0.12];
const HIT: Color = [0.25, 0.6, 1, 0.6];
const MISS: Color = [0.25, 0.6, 1, 0.1];
/** The colors of a camera's frustum: of its edges near the camera, and of those far away. */
const FRUSTUM: Color = [1, 0.75, 0.3, 0.9];
const FRUSTUM_FAR: Color = [1, 0.75, 0.3, 0.35];
/** The distance beyond which the frustum's edges are drawn fainter, m. */
const NEAR_LENGTH = 1;

/** The lines of a sensor, with the pose of the sensor in its link. */
interface SensorMark {
  readonly sensor: LidarScene | CameraScene;
  readonly local: Matrix4;
  readonly lines: ThinLines;
}

/** The rays of the lidars of a world and the frustums of its cameras. */
export class WorldSensors {
  readonly root = new Group();
  private lidars = new Map<string, SensorMark & { readonly sensor: LidarScene }>();
  private cameras: SensorMark[] = [];

  constructor() {
    this.root.matrixAutoUpdate = false;
  }

  setScene(scene: WorldScene): void {
    this.dispose();
    for (const sensor of scene.lidars) this.lidars.set(sensor.name, { ...this.mark(sensor), sensor });
    this.cameras = scene.cameras.map((sensor) => {
      const mark = this.mark(sensor);
      mark.lines.setSegments(...frustumOf(sensor));
      return mark;
    });
  }

  setRanges({ lidar, ranges }: WorldRays): void {
    const mark = this.lidars.get(lidar);
    if (!mark || ranges.length !== mark.sensor.horizontal.count * mark.sensor.vertical.count) return;
    mark.lines.setSegments(...raysOf(mark.sensor, ranges));
  }

  /** Removes the rays of a lidar. */
  forget(lidar: string): void {
    this.lidars.get(lidar)?.lines.setSegments(new Float32Array(0));
  }

  /** Shows only the sensors that the display's properties select. */
  style(rows: PropertyRows): void {
    const [rays, frustums] = [rows.text("Visualized", "Lidar Rays"), rows.text("Visualized", "Camera Frustums")];
    for (const { sensor, lines } of this.lidars.values()) lines.shown = isChosen(rays, sensor);
    for (const { sensor, lines } of this.cameras) lines.shown = isChosen(frustums, sensor);
  }

  /** Moves the lines to the poses of their links in the fixed frame. */
  place(poseOf: (link: string) => Matrix4 | null): void {
    for (const { sensor, local, lines } of [...this.lidars.values(), ...this.cameras]) {
      if (!lines.root.visible) continue;
      const pose = poseOf(sensor.link);
      if (pose) lines.root.matrix.multiplyMatrices(pose, local);
    }
  }

  /** Returns what is drawn, for tests: the number of rays of each lidar, and the cameras. */
  inspect(): object {
    const drawn = ({ lines }: SensorMark): boolean => lines.root.visible;
    const rays: Record<string, number> = {};
    for (const mark of this.lidars.values()) if (drawn(mark)) rays[mark.sensor.name] = mark.lines.count;
    return { rays, frustums: this.cameras.filter(drawn).map(({ sensor }) => sensor.name) };
  }

  dispose(): void {
    for (const { lines } of [...this.lidars.values(), ...this.cameras]) lines.dispose();
    this.lidars.clear();
    this.cameras = [];
  }

  private mark(sensor: LidarScene | CameraScene): SensorMark {
    const local = new Matrix4().compose(
      new Vector3().fromArray(sensor.position),
      new Quaternion().fromArray(sensor.quaternion),
      new Vector3(1, 1, 1),
    );
    const lines = new ThinLines();
    lines.root.matrixAutoUpdate = false;
    this.root.add(lines.root);
    return { sensor, local, lines };
  }
}

function isChosen(choice: string, { visualized }: LidarScene | CameraScene): boolean {
  return choice === "All" || (choice === "Visualized" && visualized);
}

/** Returns segments and colors of rays, from the minimum range to the hit, or to the maximum range. */
function raysOf({ horizontal, vertical, nearest, farthest }: LidarScene, ranges: Float32Array): [Float32Array, Float32Array] {
  const segments = new Float32Array(ranges.length * 6);
  const colors = new Float32Array(ranges.length * 8);
  for (let row = 0, ray = 0; row < vertical.count; row++) {
    const up = vertical.first + row * vertical.step;
    const [flat, z] = [Math.cos(up), Math.sin(up)];
    for (let column = 0; column < horizontal.count; column++, ray++) {
      const across = horizontal.first + column * horizontal.step;
      const [x, y] = [flat * Math.cos(across), flat * Math.sin(across)];
      const range = ranges[ray] ?? Infinity;
      const length = Math.min(Math.max(range, nearest), farthest);
      segments.set([nearest * x, nearest * y, nearest * z, length * x, length * y, length * z], ray * 6);
      colors.set(BEGIN, ray * 8);
      colors.set(range < farthest ? HIT : MISS, ray * 8 + 4);
    }
  }
  return [segments, colors];
}

/**
 * Returns segments and colors of a camera's frustum: the near and far planes, and the edges from the optical center.
 */
function frustumOf({ left, right, up, down, near, far }: CameraScene): [Float32Array, Float32Array] {
  const segments: number[] = [];
  const colors: number[] = [];
  const line = (from: readonly number[], to: readonly number[], color: Color): void => {
    segments.push(...from, ...to);
    colors.push(...color, ...color);
  };
  const corners = [[left, up], [-right, up], [-right, -down], [left, -down]] as const;
  let [beforeY, beforeZ] = corners[3];
  for (const [y, z] of corners) {
    const at = (x: number): number[] => [x, x * y, x * z];
    let reached = Math.min(Math.max(NEAR_LENGTH, near), far);
    line([0, 0, 0], at(reached), FRUSTUM);
    // Split the line: software renderers drop a line that extends far behind the viewer.
    for (; reached < far; reached *= 2) line(at(reached), at(Math.min(2 * reached, far)), FRUSTUM_FAR);
    line(at(near), [near, near * beforeY, near * beforeZ], FRUSTUM);
    line(at(far), [far, far * beforeY, far * beforeZ], FRUSTUM_FAR);
    [beforeY, beforeZ] = [y, z];
  }
  return [new Float32Array(segments), new Float32Array(colors)];
}
