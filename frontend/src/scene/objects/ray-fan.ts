import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, MeshBasicMaterial } from "three";
import type { LidarScene } from "../../protocol";

/** Rays farther apart are drawn as wide as this, with gaps between them, rad. */
const WIDEST = 0.035;
const COLOR = [0.25, 0.6, 1] as const;
/** How much of what is behind is covered where rays begin, and where they hit something. */
const BEGIN = 0.3;
const HIT = 0.4;
/** So much of a ray is seen to begin, and before a hit so many metres of it, or a share where it is short. */
const GLOW = 0.4;
const RIM = 0.2;
const RIM_SHARE = 0.1;
/** Of a ray: both sides where it begins, where that has faded, where it comes into view again, and where it hits. */
const CORNERS = 8;
const FACES = [0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7];

/**
 * The rays of a lidar as areas that each ray fills half way to its neighbours: a glow around the lidar, which fades, and a
 * rim before what the rays hit. What is between is left to the world, and costs nothing: where the processor draws, each
 * pixel that is seen through costs as much as several others. Rows are the fainter the more there are.
 */
export class RayFan {
  readonly root: Mesh<BufferGeometry, MeshBasicMaterial>;
  /** Unit vectors along the left and the right side of each ray. */
  private readonly sides: Float32Array;
  private measured = 0;
  private isShown = true;

  constructor(private readonly lidar: LidarScene) {
    const { horizontal, vertical } = lidar;
    const rays = horizontal.count * vertical.count;
    const geometry = new BufferGeometry();
    const positions = new BufferAttribute(new Float32Array(rays * CORNERS * 3), 3).setUsage(DynamicDrawUsage);
    const colors = new BufferAttribute(new Float32Array(rays * CORNERS * 4), 4).setUsage(DynamicDrawUsage);
    for (let corner = 0; corner < rays * CORNERS; corner++) colors.setXYZ(corner, ...COLOR);
    geometry.setAttribute("position", positions).setAttribute("color", colors);
    geometry.setIndex(Array.from({ length: rays }, (_, ray) => FACES.map((each) => ray * CORNERS + each)).flat());
    const look = { vertexColors: true, transparent: true, depthWrite: false, side: DoubleSide, forceSinglePass: true } as const;
    this.root = new Mesh(geometry, new MeshBasicMaterial(look));
    this.root.frustumCulled = this.root.visible = false;
    this.sides = sidesOf(lidar);
  }

  /** Shows how far the rays go, m; none for an array of another size. */
  set(ranges: Float32Array): void {
    const { nearest, farthest, vertical } = this.lidar;
    const { position, color } = this.root.geometry.attributes as Record<"position" | "color", BufferAttribute>;
    this.measured = ranges.length * CORNERS === position.count ? ranges.length : 0;
    const share = Math.min(1, 2 / vertical.count);
    for (let ray = 0; ray < this.measured; ray++) {
      const range = ranges[ray] ?? Infinity;
      const reached = Math.min(Math.max(range, nearest), farthest);
      const isHit = range < farthest;
      const rim = Math.max(nearest, reached - Math.min(RIM, RIM_SHARE * reached));
      const lengths = [nearest, nearest + GLOW * (reached - nearest), rim, reached];
      const alphas = [BEGIN, 0, 0, isHit ? HIT : 0];
      for (let corner = 0; corner < CORNERS; corner++) {
        const at = ray * CORNERS + corner;
        const length = lengths[corner >> 1] ?? 0;
        const side = (ray * 2 + (corner & 1)) * 3;
        const [x = 0, y = 0, z = 0] = this.sides.subarray(side, side + 3);
        position.setXYZ(at, length * x, length * y, length * z);
        color.setW(at, share * (alphas[corner >> 1] ?? 0));
      }
    }
    position.needsUpdate = color.needsUpdate = true;
    this.show();
  }

  /** How many rays are drawn. */
  get count(): number {
    return this.measured;
  }

  /** Whether they are to be seen. */
  set shown(shown: boolean) {
    this.isShown = shown;
    this.show();
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
  }

  private show(): void {
    this.root.visible = this.isShown && this.measured > 0;
  }
}

function sidesOf({ horizontal, vertical }: LidarScene): Float32Array {
  const half = Math.min(Math.abs(horizontal.step) || WIDEST, WIDEST) / 2;
  const sides: number[] = [];
  for (let row = 0; row < vertical.count; row++) {
    const up = vertical.first + row * vertical.step;
    for (let column = 0; column < horizontal.count; column++) {
      const across = horizontal.first + column * horizontal.step;
      for (const angle of [across + half, across - half]) {
        sides.push(Math.cos(up) * Math.cos(angle), Math.cos(up) * Math.sin(angle), Math.sin(up));
      }
    }
  }
  return new Float32Array(sides);
}
