import { Box3, ExtrudeGeometry, Path, PlaneGeometry, Shape as Outline, ShapeUtils, Vector2, Vector3, type BufferGeometry } from "three";
import type { Submesh } from "../../protocol";
import type { MeshPart } from "../meshes/mesh-template";

/**
 * Extrudes polygons (x y x y ...) along z; a polygon within another is a hole, and one within a hole is solid again.
 */
export function extrudePolygons(outlines: readonly (readonly number[])[], height: number): BufferGeometry {
  const polygons = outlines.map((coordinates) => {
    return Array.from({ length: Math.floor(coordinates.length / 2) }, (_, i) => new Vector2(coordinates[2 * i], coordinates[2 * i + 1]));
  }).filter((points) => points.length > 2);
  const enclosingPolygons = polygons.map((points) => polygons.filter((candidate) => candidate !== points && containsPoint(candidate, points[0])));
  const shapes: Outline[] = [];
  polygons.forEach((points, i) => {
    if ((enclosingPolygons[i] ?? []).length % 2 === 1) return;
    const shape = new Outline(points);
    polygons.forEach((hole, j) => {
      const enclosing = enclosingPolygons[j] ?? [];
      if (enclosing.includes(points) && enclosing.length === (enclosingPolygons[i] ?? []).length + 1) shape.holes.push(new Path(hole));
    });
    shapes.push(shape);
  });
  return new ExtrudeGeometry(shapes, { depth: height, bevelEnabled: false, steps: 1 });
}

/**
 * Returns the parts of a mesh with a name, or all parts for null; `offset` moves the mesh if its center is to be the
 * origin.
 */
export function selectSubmesh(parts: readonly MeshPart[], selection: Submesh | null): { parts: readonly MeshPart[]; offset: Vector3 } {
  const offset = new Vector3();
  if (selection === null) return { parts, offset };
  const selectedParts = parts.filter(({ names }) => names?.includes(selection.name));
  if (selectedParts.length === 0) throw new Error(`the mesh has no part '${selection.name}'`);
  if (selection.center) {
    const box = new Box3();
    for (const { geometry } of selectedParts) {
      geometry.computeBoundingBox();
      if (geometry.boundingBox) box.union(geometry.boundingBox);
    }
    box.getCenter(offset).negate();
  }
  return { parts: selectedParts, offset };
}

/**
 * Returns the surface of a heightmap.
 *
 * @param heights - heights relative to the maximum, row by row from the smallest y, each from the smallest x.
 * @param columns - the number of heights in a row.
 * @param size - x, y, z of the ground, the offset of its center, and the side length that a texture covers, m.
 */
export function createHeightmap(heights: Float32Array, columns: number, size: readonly number[]): BufferGeometry {
  const [x = 1, y = 1, z = 1, dx = 0, dy = 0, dz = 0, tileSize = 1] = size;
  const rows = Math.floor(heights.length / Math.max(1, columns));
  const geometry = new PlaneGeometry(x, y, Math.max(1, columns - 1), Math.max(1, rows - 1));
  const positions = geometry.getAttribute("position");
  const uvs = geometry.getAttribute("uv");
  const [tilesX, tilesY] = tileSize > 0 ? [x / tileSize, y / tileSize] : [1, 1];
  for (let i = 0; i < positions.count; i++) {
    // The vertices of a plane start at the greatest y.
    const row = rows - 1 - Math.floor(i / columns);
    positions.setZ(i, (heights[row * columns + (i % columns)] ?? 0) * z);
    uvs.setXY(i, uvs.getX(i) * tilesX, uvs.getY(i) * tilesY);
  }
  geometry.translate(dx, dy, dz);
  geometry.computeVertexNormals();
  return geometry;
}

function containsPoint(polygon: readonly Vector2[], point: Vector2 | undefined): boolean {
  if (!point || ShapeUtils.area([...polygon]) === 0) return false;
  let isInside = false;
  polygon.forEach((edgeStart, i) => {
    const edgeEnd = polygon[(i + 1) % polygon.length] ?? edgeStart;
    if (edgeStart.y > point.y === edgeEnd.y > point.y) return;
    const crossingX = ((edgeEnd.x - edgeStart.x) * (point.y - edgeStart.y)) / (edgeEnd.y - edgeStart.y) + edgeStart.x;
    if (point.x < crossingX) isInside = !isInside;
  });
  return isInside;
}
