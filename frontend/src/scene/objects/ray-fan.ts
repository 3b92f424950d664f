import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, MeshBasicMaterial } from "three";
import type { LidarScene } from "../../protocol";

/** Rays farther apart are drawn as wide as this, with gaps between them, rad. */
const WIDEST = 0.035;
const COLOR = [0.25, 0.6, 1] as const;
/** How much of what is behind is covered: where rays begin, where they hit something, and where others begin. */
const BEGIN = 0.18;
const HIT = 0.04;
const BEGIN_OF_MISS = 0.06;
const CORNERS = 4;

/**
 * The rays of a lidar as a faint area, which each ray fills half way to its neighbours, from the nearest distance that is
 * measured to what it met; rays that met nothing fade away. Rows above each other are the fainter the more there are.
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
    geometry.setIndex(Array.from({ length: rays }, (_, ray) => [0, 1, 2, 2, 1, 3].map((each) => ray * CORNERS + each)).flat());
    const look = { vertexColors: true, transparent: true, depthWrite: false, side: DoubleSide } as const;
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
      for (let corner = 0; corner < CORNERS; corner++) {
        const [at, isFar] = [ray * CORNERS + corner, corner >= 2];
        const length = isFar ? reached : nearest;
        const side = (ray * 2 + (corner & 1)) * 3;
        const [x = 0, y = 0, z = 0] = this.sides.subarray(side, side + 3);
        position.setXYZ(at, length * x, length * y, length * z);
        color.setW(at, share * (isFar ? (isHit ? HIT : 0) : isHit ? BEGIN : BEGIN_OF_MISS));
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
