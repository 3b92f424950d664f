import { Group, Matrix4, Quaternion, Vector3 } from "three";
import type { CameraScene, LidarScene, WorldRays, WorldScene } from "../../protocol";
import type { PropertyRows } from "../../state/properties";
import { ThinLines } from "../objects/thin-lines";

type Color = readonly [number, number, number, number];

/**
 * Colors (r g b a, 0 to 1) of rays: at the sensor, where rays are dense; at a hit; at the end of a ray without a hit.
 */
const RAY_START_COLOR: Color = [0.25, 0.6, 1, 0.12];
const RAY_HIT_COLOR: Color = [0.25, 0.6, 1, 0.6];
const RAY_MISS_COLOR: Color = [0.25, 0.6, 1, 0.1];
/** The colors of a camera's frustum: of its edges near the camera, and of those far away. */
const FRUSTUM_COLOR: Color = [1, 0.75, 0.3, 0.9];
const FAR_FRUSTUM_COLOR: Color = [1, 0.75, 0.3, 0.35];
/** The distance beyond which the frustum's edges are drawn fainter, m. */
const NEAR_LENGTH_M = 1;

/** The lines of a sensor, with the pose of the sensor in its link. */
interface SensorMark {
  readonly sensor: LidarScene | CameraScene;
  readonly localPose: Matrix4;
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
    for (const sensor of scene.lidars) this.lidars.set(sensor.name, { ...this.createMark(sensor), sensor });
    this.cameras = scene.cameras.map((sensor) => {
      const mark = this.createMark(sensor);
      mark.lines.setSegments(...createFrustum(sensor));
      return mark;
    });
  }

  setRanges({ lidar, ranges }: WorldRays): void {
    const mark = this.lidars.get(lidar);
    if (!mark || ranges.length !== mark.sensor.horizontal.count * mark.sensor.vertical.count) return;
    mark.lines.setSegments(...createRays(mark.sensor, ranges));
  }

  /** Removes the rays of a lidar. */
  forget(lidar: string): void {
    this.lidars.get(lidar)?.lines.setSegments(new Float32Array(0));
  }

  /** Shows only the sensors that the display's properties select. */
  applyStyle(rows: PropertyRows): void {
    const [rays, frustums] = [rows.text("Visualized", "Lidar Rays"), rows.text("Visualized", "Camera Frustums")];
    for (const { sensor, lines } of this.lidars.values()) lines.isShown = isSelected(rays, sensor);
    for (const { sensor, lines } of this.cameras) lines.isShown = isSelected(frustums, sensor);
  }

  /** Moves the lines to the poses of their links in the fixed frame. */
  placeSensors(poseOf: (link: string) => Matrix4 | null): void {
    for (const { sensor, localPose, lines } of [...this.lidars.values(), ...this.cameras]) {
      if (!lines.root.visible) continue;
      const pose = poseOf(sensor.link);
      if (pose) lines.root.matrix.multiplyMatrices(pose, localPose);
    }
  }

  /** Returns what is drawn, for tests: the number of rays of each lidar, and the cameras. */
  inspect(): object {
    const isDrawn = ({ lines }: SensorMark): boolean => lines.root.visible;
    const rays: Record<string, number> = {};
    for (const mark of this.lidars.values()) if (isDrawn(mark)) rays[mark.sensor.name] = mark.lines.count;
    return { rays, frustums: this.cameras.filter(isDrawn).map(({ sensor }) => sensor.name) };
  }

  dispose(): void {
    for (const { lines } of [...this.lidars.values(), ...this.cameras]) lines.dispose();
    this.lidars.clear();
    this.cameras = [];
  }

  private createMark(sensor: LidarScene | CameraScene): SensorMark {
    const localPose = new Matrix4().compose(
      new Vector3().fromArray(sensor.position),
      new Quaternion().fromArray(sensor.quaternion),
      new Vector3(1, 1, 1),
    );
    const lines = new ThinLines();
    lines.root.matrixAutoUpdate = false;
    this.root.add(lines.root);
    return { sensor, localPose, lines };
  }
}

function isSelected(choice: string, { visualized }: LidarScene | CameraScene): boolean {
  return choice === "All" || (choice === "Visualized" && visualized);
}

/** Returns segments and colors of rays, from the minimum range to the hit, or to the maximum range. */
function createRays({ horizontal, vertical, nearest, farthest }: LidarScene, ranges: Float32Array): [Float32Array, Float32Array] {
  const segments = new Float32Array(ranges.length * 6);
  const colors = new Float32Array(ranges.length * 8);
  for (let row = 0, ray = 0; row < vertical.count; row++) {
    const elevation = vertical.first + row * vertical.step;
    const [horizontalLength, z] = [Math.cos(elevation), Math.sin(elevation)];
    for (let column = 0; column < horizontal.count; column++, ray++) {
      const azimuth = horizontal.first + column * horizontal.step;
      const [x, y] = [horizontalLength * Math.cos(azimuth), horizontalLength * Math.sin(azimuth)];
      const range = ranges[ray] ?? Infinity;
      const length = Math.min(Math.max(range, nearest), farthest);
      segments.set([nearest * x, nearest * y, nearest * z, length * x, length * y, length * z], ray * 6);
      colors.set(RAY_START_COLOR, ray * 8);
      colors.set(range < farthest ? RAY_HIT_COLOR : RAY_MISS_COLOR, ray * 8 + 4);
    }
  }
  return [segments, colors];
}

/**
 * Returns segments and colors of a camera's frustum: the near and far planes, and the edges from the optical center.
 */
function createFrustum({ left, right, up: elevation, down, near, far }: CameraScene): [Float32Array, Float32Array] {
  const segments: number[] = [];
  const colors: number[] = [];
  const addLine = (start: readonly number[], end: readonly number[], color: Color): void => {
    segments.push(...start, ...end);
    colors.push(...color, ...color);
  };
  const corners = [[left, elevation], [-right, elevation], [-right, -down], [left, -down]] as const;
  let [previousY, previousZ] = corners[3];
  for (const [y, z] of corners) {
    const pointAt = (x: number): number[] => [x, x * y, x * z];
    let distance = Math.min(Math.max(NEAR_LENGTH_M, near), far);
    addLine([0, 0, 0], pointAt(distance), FRUSTUM_COLOR);
    // Split the line: software renderers drop a line that extends far behind the viewer.
    for (; distance < far; distance *= 2) addLine(pointAt(distance), pointAt(Math.min(2 * distance, far)), FAR_FRUSTUM_COLOR);
    addLine(pointAt(near), [near, near * previousY, near * previousZ], FRUSTUM_COLOR);
    addLine(pointAt(far), [far, far * previousY, far * previousZ], FAR_FRUSTUM_COLOR);
    [previousY, previousZ] = [y, z];
  }
  return [new Float32Array(segments), new Float32Array(colors)];
}
