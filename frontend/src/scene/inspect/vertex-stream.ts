import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  DynamicDrawUsage,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  type Object3D,
  type Vector3,
} from "three";

const INITIAL_CAPACITY = 256;
/** Marks are drawn after the robot and before labels. */
const RENDER_ORDER = 6;

/** Lines or triangles that change in every frame, unlit and drawn over everything, in one draw call. */
export class VertexStream {
  private readonly object: LineSegments | Mesh;
  private positions = new Float32Array(INITIAL_CAPACITY * 3);
  private colors = new Float32Array(INITIAL_CAPACITY * 4);
  private count = 0;
  private readonly color = new Color();
  private alpha = 1;

  constructor(parent: Object3D, kind: "lines" | "triangles") {
    const style = { vertexColors: true, transparent: true, depthTest: false, depthWrite: false };
    this.object =
      kind === "lines"
        ? new LineSegments(new BufferGeometry(), new LineBasicMaterial(style))
        : new Mesh(new BufferGeometry(), new MeshBasicMaterial({ ...style, side: DoubleSide }));
    this.object.frustumCulled = false;
    this.object.matrixAutoUpdate = false;
    this.object.visible = false;
    this.object.renderOrder = RENDER_ORDER;
    this.allocate();
    parent.add(this.object);
  }

  /** The number of vertices drawn now. */
  get size(): number {
    return this.count;
  }

  begin(): void {
    this.count = 0;
  }

  /** Sets the look of the vertices added from now on; `color` is 0xrrggbb. */
  setLook(color: number, alpha = 1): void {
    this.color.setHex(color);
    this.alpha = alpha;
  }

  add(...vertices: readonly Vector3[]): void {
    for (const vertex of vertices) {
      if (this.count * 3 === this.positions.length) this.grow();
      vertex.toArray(this.positions, this.count * 3);
      this.color.toArray(this.colors, this.count * 4);
      this.colors[this.count * 4 + 3] = this.alpha;
      this.count += 1;
    }
  }

  end(): void {
    const { geometry } = this.object;
    this.object.visible = this.count > 0;
    geometry.setDrawRange(0, this.count);
    for (const name of ["position", "color"]) {
      const attribute = geometry.getAttribute(name) as BufferAttribute;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, this.count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }

  private grow(): void {
    const [positions, colors] = [this.positions, this.colors];
    this.positions = new Float32Array(positions.length * 2);
    this.colors = new Float32Array(colors.length * 2);
    this.positions.set(positions);
    this.colors.set(colors);
    this.allocate();
  }

  private allocate(): void {
    // A buffer on the GPU cannot grow: a larger one needs a new geometry.
    this.object.geometry.dispose();
    this.object.geometry = new BufferGeometry()
      .setAttribute("position", new BufferAttribute(this.positions, 3).setUsage(DynamicDrawUsage))
      .setAttribute("color", new BufferAttribute(this.colors, 4).setUsage(DynamicDrawUsage));
  }
}
