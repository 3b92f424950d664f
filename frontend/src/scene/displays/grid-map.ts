import { BufferAttribute, BufferGeometry, DoubleSide, Matrix4, Mesh, MeshLambertMaterial, Vector3, type Box3 } from "three";
import type { GridSurface } from "../../protocol";
import { MIN_OPAQUE_ALPHA } from "../materials";
import { concatenate, ThinLines } from "../objects/thin-lines";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";

/** grid_map_rviz_plugin/GridMap: a surface through the centers of the cells, and lines between them. */
export class GridMapDrawing extends ContentDrawing<"grid_surface"> {
  private readonly lines = new ThinLines();
  private readonly surfaces = new Map<GridSurface, Mesh<BufferGeometry, MeshLambertMaterial>>();

  constructor(context: DrawingContext) {
    super(context, "grid_surface");
    this.root.add(this.lines.root);
  }

  dispose(): void {
    this.lines.dispose();
    for (const surface of [...this.surfaces.keys()]) this.remove(surface);
  }

  protected override inspectContents(): object {
    const meshes = [...this.surfaces.values()];
    const triangles = meshes.reduce((sum, { geometry, visible }) => sum + (visible ? (geometry.index?.count ?? 0) / 3 : 0), 0);
    return { triangles, lines: this.lines.root.visible ? this.lines.count : 0 };
  }

  protected expandBox(box: Box3): void {
    for (const mesh of this.surfaces.values()) box.expandByObject(mesh);
    this.lines.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const alpha = rows.number(1, "Alpha");
    const posedContents = this.listPosedContents();
    const surfaces = new Set(posedContents.map(({ content }) => content));
    for (const surface of [...this.surfaces.keys()]) if (!surfaces.has(surface)) this.remove(surface);
    for (const { content, pose } of posedContents) {
      const mesh = this.surfaces.get(content) ?? this.createMesh(content);
      pose.decompose(mesh.position, mesh.quaternion, new Vector3());
      mesh.visible = content.filled && alpha > 0;
      mesh.material.opacity = alpha;
      mesh.material.transparent = alpha < MIN_OPAQUE_ALPHA;
      mesh.material.depthWrite = alpha >= MIN_OPAQUE_ALPHA;
    }
    const segments = rows.bool(true, "Show Grid Lines") ? posedContents.map(({ content, pose }) => createSegments(content, pose)) : [];
    this.lines.setSegments(concatenate(segments));
    this.lines.setStyle("#000000", alpha);
  }

  private createMesh(content: GridSurface): Mesh<BufferGeometry, MeshLambertMaterial> {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(content.points, 3));
    geometry.setAttribute("color", new BufferAttribute(readRgb(content), 3, true));
    geometry.setIndex(createTriangles(content));
    geometry.computeVertexNormals();
    const mesh = new Mesh(geometry, new MeshLambertMaterial({ side: DoubleSide, vertexColors: true }));
    this.surfaces.set(content, mesh);
    this.root.add(mesh);
    return mesh;
  }

  private remove(content: GridSurface): void {
    const mesh = this.surfaces.get(content);
    mesh?.removeFromParent();
    mesh?.geometry.dispose();
    mesh?.material.dispose();
    this.surfaces.delete(content);
  }
}

function hasCell({ colors }: GridSurface, cell: number): boolean {
  return colors[cell * 4 + 3] !== 0;
}

function readRgb({ colors }: GridSurface): Uint8Array {
  const rgb = new Uint8Array((colors.length / 4) * 3);
  for (let cell = 0; cell < colors.length / 4; cell++) rgb.set(colors.subarray(cell * 4, cell * 4 + 3), cell * 3);
  return rgb;
}

/** Returns the triangles: two between four existing cells, one between three. */
function createTriangles(content: GridSurface): number[] {
  const { rows, columns } = content;
  const triangles: number[] = [];
  for (let row = 0; row + 1 < rows; row++) {
    for (let column = 0; column + 1 < columns; column++) {
      const firstCell = row * columns + column;
      const corners = [firstCell, firstCell + columns, firstCell + columns + 1, firstCell + 1].filter((cell) => hasCell(content, cell));
      const [a = 0, b = 0, c = 0, d = 0] = corners;
      if (corners.length >= 3) triangles.push(a, b, c);
      if (corners.length === 4) triangles.push(a, c, d);
    }
  }
  return triangles;
}

function createSegments(content: GridSurface, pose: Matrix4): Float32Array {
  const { rows, columns, points } = content;
  const positions = new Float32Array(points.length);
  const position = new Vector3();
  for (let i = 0; i < points.length; i += 3) position.fromArray(points, i).applyMatrix4(pose).toArray(positions, i);
  const segments: number[] = [];
  const connect = (firstCell: number, secondCell: number): void => {
    if (!hasCell(content, firstCell) || !hasCell(content, secondCell)) return;
    segments.push(...positions.subarray(firstCell * 3, firstCell * 3 + 3), ...positions.subarray(secondCell * 3, secondCell * 3 + 3));
  };
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      const cell = row * columns + column;
      if (row + 1 < rows) connect(cell, cell + columns);
      if (column + 1 < columns) connect(cell, cell + 1);
    }
  }
  return Float32Array.from(segments);
}
