import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Matrix4, Mesh, MeshBasicMaterial, Vector3, type Camera } from "three";
import type { WorldWater } from "../../protocol";

/** The number of cells along a side of the grid. */
const CELL_COUNT = 112;
/** How much smaller cells at the center are than with equal cells. */
const CENTER_DENSITY = 0.3;
/** The limits of half the side of the drawn square, m, and that half as a multiple of the distance of the camera. */
const MIN_HALF_SIDE_M = 40;
const MAX_HALF_SIDE_M = 400;
const HALF_SIDE_PER_DISTANCE = 3;
/** The square stays near a camera that looks at the horizon: its distance is limited to this multiple of the height. */
const MAX_DISTANCE_PER_HEIGHT = 3;
/** Half the side changes by this factor, and the center by this share of it, so that the grid rarely moves. */
const ZOOM_STEP = 1.3;
const CENTER_STEP = 0.04;
/** The surface fades out from this share of half the side to its border. */
const FADE_START = 0.75;

/** Colors (r g b, linear) of slopes away from the light and towards it, and the opacity. */
const DARK_COLOR = [0.005, 0.04, 0.13] as const;
const BRIGHT_COLOR = [0.12, 0.4, 0.6] as const;
const OPACITY = 0.78;
/** The brightness of calm water between both colors, how much slopes change it, and the slope that does most of it. */
const CALM_BRIGHTNESS = 0.4;
const SLOPE_CONTRAST = 0.5;
const CLEAR_SLOPE = 0.1;
/** The horizontal direction from which slopes are bright. */
const LIGHT_X = 0.8;
const LIGHT_Y = 0.6;

const WAVE_SIZE = 6;

/** Returns the factor by which the waves have grown at a simulated time. */
function computeGrowth({ growth_time }: WorldWater, seconds: number): number {
  return growth_time > 0 ? 1 - Math.exp(-Math.max(seconds, 0) / growth_time) : 1;
}

/**
 * Computes the position of the particle of the water that rests at x and y, m, and the slope of the surface there;
 * writes x, y, z, dz/dx, dz/dy to `result`. It is the same surface as that of `WaveField` in `simulation/plugins/boats`.
 */
export function computeParticle(water: WorldWater, x: number, y: number, seconds: number, result: Float64Array): void {
  const { waves, level } = water;
  const growth = computeGrowth(water, seconds);
  let [movedX, movedY, z] = [x, y, level];
  // The derivatives of the position with respect to the rest position.
  let [xx, xy, yy, zx, zy] = [1, 0, 1, 0, 0];
  for (let i = 0; i < waves.length; i += WAVE_SIZE) {
    const amplitude = growth * (waves[i] ?? 0);
    const wavenumber = waves[i + 2] ?? 0;
    const displacement = (waves[i + 3] ?? 0) * amplitude;
    const [directionX, directionY] = [waves[i + 4] ?? 0, waves[i + 5] ?? 0];
    const phase = wavenumber * (directionX * x + directionY * y) - (waves[i + 1] ?? 0) * seconds;
    const [sine, cosine] = [Math.sin(phase), Math.cos(phase)];
    movedX -= displacement * directionX * sine;
    movedY -= displacement * directionY * sine;
    z += amplitude * cosine;
    const stretch = displacement * wavenumber * cosine;
    xx -= stretch * directionX * directionX;
    xy -= stretch * directionX * directionY;
    yy -= stretch * directionY * directionY;
    zx -= amplitude * wavenumber * directionX * sine;
    zy -= amplitude * wavenumber * directionY * sine;
  }
  const determinant = xx * yy - xy * xy || 1;
  result[0] = movedX;
  result[1] = movedY;
  result[2] = z;
  result[3] = (zx * yy - zy * xy) / determinant;
  result[4] = (zy * xx - zx * xy) / determinant;
}

/** The surface of the water of a world: a translucent square around the point at which the camera looks. */
export class WaterSurface {
  readonly root: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly positions = createAttribute(3);
  private readonly colors = createAttribute(4);
  private readonly offsets = Float64Array.from({ length: CELL_COUNT + 1 }, (_, i) => {
    const share = (2 * i) / CELL_COUNT - 1;
    return share * (CENTER_DENSITY + (1 - CENTER_DENSITY) * share * share);
  });
  private readonly particle = new Float64Array(5);
  /** The state that is drawn. */
  private drawn: { water: WorldWater; seconds: number; x: number; y: number; halfSide: number } | null = null;

  constructor() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.positions);
    geometry.setAttribute("color", this.colors);
    geometry.setIndex(createIndices());
    const material = new MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false, side: 2, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.root = new Mesh(geometry, material);
    this.root.matrixAutoUpdate = false;
    this.root.frustumCulled = false;
  }

  /** Computes the surface at a simulated time, s, around the view of a camera. `worldPose` is in the fixed frame. */
  update(water: WorldWater, seconds: number, camera: Camera, worldPose: Matrix4): void {
    this.root.matrix.copy(worldPose);
    this.root.matrixWorldNeedsUpdate = true;
    const { x, y, halfSide } = findSquare(camera, worldPose, water.level);
    const time = water.waves.length > 0 ? seconds : 0;
    const { drawn } = this;
    if (drawn?.water === water && drawn.seconds === time && drawn.x === x && drawn.y === y && drawn.halfSide === halfSide) return;
    this.drawn = { water, seconds: time, x, y, halfSide };
    this.computeVertices(water, time, x, y, halfSide);
  }

  /** Returns what is drawn, for tests: the time, and the positions of some vertices in the frame of the world. */
  inspect(): object {
    const middle = Math.floor(this.positions.count / 2);
    const samples = [0, 9, 500, 1234].map((step) => [0, 1, 2].map((i) => this.positions.array[(middle + step) * 3 + i]));
    return { seconds: this.drawn?.seconds ?? null, samples };
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
  }

  private computeVertices(water: WorldWater, seconds: number, centerX: number, centerY: number, halfSide: number): void {
    const { offsets, particle } = this;
    const [positions, colors] = [this.positions.array, this.colors.array];
    let vertex = 0;
    for (const offsetY of offsets) {
      for (const offsetX of offsets) {
        computeParticle(water, centerX + halfSide * offsetX, centerY + halfSide * offsetY, seconds, particle);
        positions[vertex * 3] = particle[0] ?? 0;
        positions[vertex * 3 + 1] = particle[1] ?? 0;
        positions[vertex * 3 + 2] = particle[2] ?? 0;
        const slope = LIGHT_X * (particle[3] ?? 0) + LIGHT_Y * (particle[4] ?? 0);
        const brightness = Math.max(CALM_BRIGHTNESS - (SLOPE_CONTRAST * slope) / Math.hypot(slope, CLEAR_SLOPE), 0);
        for (let i = 0; i < 3; i++) {
          const dark = DARK_COLOR[i] ?? 0;
          colors[vertex * 4 + i] = dark + brightness * ((BRIGHT_COLOR[i] ?? 0) - dark);
        }
        const fade = (1 - Math.hypot(offsetX, offsetY)) / (1 - FADE_START);
        colors[vertex * 4 + 3] = OPACITY * Math.min(Math.max(fade, 0), 1);
        vertex++;
      }
    }
    this.positions.needsUpdate = this.colors.needsUpdate = true;
  }
}

/** Returns the center and half the side of the square that is drawn, m, in the frame of the world. */
function findSquare(camera: Camera, worldPose: Matrix4, level: number): { x: number; y: number; halfSide: number } {
  const toWorld = worldPose.clone().invert();
  const position = new Vector3().setFromMatrixPosition(camera.matrixWorld).applyMatrix4(toWorld);
  const direction = camera.getWorldDirection(new Vector3()).transformDirection(toWorld);
  const maxDistance = Math.max(MAX_HALF_SIDE_M / HALF_SIDE_PER_DISTANCE, MAX_DISTANCE_PER_HEIGHT * Math.abs(position.z - level));
  const hitDistance = (level - position.z) / direction.z;
  const distance = hitDistance > 0 ? Math.min(hitDistance, maxDistance) : maxDistance;
  const steps = Math.ceil(Math.log((HALF_SIDE_PER_DISTANCE * distance) / MIN_HALF_SIDE_M) / Math.log(ZOOM_STEP));
  const halfSide = Math.min(MIN_HALF_SIDE_M * ZOOM_STEP ** Math.max(steps, 0), MAX_HALF_SIDE_M);
  const step = CENTER_STEP * halfSide;
  const snap = (value: number): number => Math.round(value / step) * step;
  return { x: snap(position.x + distance * direction.x), y: snap(position.y + distance * direction.y), halfSide };
}

function createAttribute(itemSize: number): BufferAttribute {
  const attribute = new BufferAttribute(new Float32Array((CELL_COUNT + 1) ** 2 * itemSize), itemSize);
  attribute.setUsage(DynamicDrawUsage);
  return attribute;
}

function createIndices(): number[] {
  const indices: number[] = [];
  const rowLength = CELL_COUNT + 1;
  for (let row = 0; row < CELL_COUNT; row++) {
    for (let column = 0; column < CELL_COUNT; column++) {
      const corner = row * rowLength + column;
      indices.push(corner, corner + 1, corner + rowLength, corner + 1, corner + rowLength + 1, corner + rowLength);
    }
  }
  return indices;
}
