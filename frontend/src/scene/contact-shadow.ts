import { Box3, DataTexture, Group, LinearFilter, Mesh, MeshBasicMaterial, PlaneGeometry, Vector3 } from "three";
import { getSamples } from "./robot/surface-samples";

/** Texels along each side of the shadow's image. */
const TEXELS_PER_SIDE = 96;
/** The width of the ground that the image covers, in widths of the robot. */
const GROUND_WIDTHS = 1.7;
/** The maximum darkness. */
const MAX_DARKNESS = 0.62;
/**
 * The heights above the ground, in sizes of the robot, over which the shade of a surface decreases by a factor of e:
 * near the ground, and far from it.
 */
const [NEAR_DECAY, FAR_DECAY] = [0.05, 0.35];
/** The weight of the shade from far surfaces. */
const FAR_WEIGHT = 0.35;
/** The radius of the blur in texels, and the number of its passes. */
const [BLUR_RADIUS, BLUR_PASSES] = [2, 3];
/** The shadow is drawn first among transparent objects, so that lines on the ground cover it. */
const RENDER_ORDER = -1;

const position = new Vector3();

/**
 * The ambient shadow of a robot on the ground, as on a cloudy day. It is computed from a few points of each surface,
 * and only when the robot moved, without a light or a further rendering of the scene.
 */
export class ContactShadow {
  readonly root = new Group();
  /** The plane that shows the image of the shadow. */
  readonly ground: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly pixels = new Uint8Array(4 * TEXELS_PER_SIDE * TEXELS_PER_SIDE);
  private readonly texture = new DataTexture(this.pixels, TEXELS_PER_SIDE, TEXELS_PER_SIDE);
  private shade = new Float32Array(TEXELS_PER_SIDE * TEXELS_PER_SIDE);
  private blurBuffer = new Float32Array(TEXELS_PER_SIDE * TEXELS_PER_SIDE);
  private lastKey = NaN;

  constructor() {
    this.texture.magFilter = this.texture.minFilter = LinearFilter;
    const style = { map: this.texture, transparent: true, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    this.ground = new Mesh(new PlaneGeometry(), new MeshBasicMaterial(style));
    this.ground.renderOrder = RENDER_ORDER;
    this.root.add(this.ground);
  }

  /**
   * Computes the shadow of meshes, whose world matrices must be current, on a ground at this height in the fixed frame,
   * m.
   */
  update(meshes: readonly Mesh[], height: number): void {
    const key = meshes.reduce((sum, { matrixWorld }, i) => matrixWorld.elements.reduce((total, element, k) => total + element * (i + k + 1), sum), height);
    if (key === this.lastKey) return;
    this.lastKey = key;
    const box = new Box3();
    for (const mesh of meshes) box.expandByObject(mesh);
    if (box.isEmpty()) return void (this.ground.visible = false);
    const [center, size] = [box.getCenter(new Vector3()), box.getSize(new Vector3())];
    const width = Math.max(GROUND_WIDTHS * Math.max(size.x, size.y), size.z * (GROUND_WIDTHS - 1));
    this.ground.visible = true;
    this.ground.position.set(center.x, center.y, height);
    this.ground.scale.setScalar(width);
    this.shade.fill(0);
    for (const mesh of meshes) this.addMesh(mesh, center, width, height, size.length());
    for (let i = 0; i < BLUR_PASSES; i++) this.blur();
    this.shade.forEach((shade, i) => (this.pixels[4 * i + 3] = 255 * MAX_DARKNESS * (1 - Math.exp(-shade))));
    this.texture.needsUpdate = true;
  }

  private addMesh({ geometry, matrixWorld }: Mesh, center: Vector3, width: number, height: number, size: number): void {
    const { points, area } = getSamples(geometry);
    const areaScale = Math.cbrt(Math.abs(matrixWorld.determinant())) ** 2;
    const texelCount = (area * areaScale) / (width / TEXELS_PER_SIDE) ** 2;
    for (let i = 0; i < points.length; i += 3) {
      position.fromArray(points, i).applyMatrix4(matrixWorld);
      const heightAbove = Math.max(0, position.z - height) / size;
      const x = Math.floor(((position.x - center.x) / width + 0.5) * TEXELS_PER_SIDE);
      const y = Math.floor(((position.y - center.y) / width + 0.5) * TEXELS_PER_SIDE);
      const texel = y * TEXELS_PER_SIDE + x;
      this.shade[texel] = (this.shade[texel] ?? 0) + texelCount * (Math.exp(-heightAbove / NEAR_DECAY) + FAR_WEIGHT * Math.exp(-heightAbove / FAR_DECAY));
    }
  }

  /** Replaces each texel by the mean of a square around it. */
  private blur(): void {
    for (const step of [1, TEXELS_PER_SIDE]) {
      const [source, target] = [this.shade, this.blurBuffer];
      for (let i = 0; i < source.length; i++) {
        let sum = 0;
        for (let k = -BLUR_RADIUS; k <= BLUR_RADIUS; k++) sum += source[i + k * step] ?? 0;
        target[i] = sum / (2 * BLUR_RADIUS + 1);
      }
      [this.shade, this.blurBuffer] = [target, source];
    }
  }
}
