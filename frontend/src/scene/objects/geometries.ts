import {
  BoxGeometry,
  CapsuleGeometry,
  CircleGeometry,
  ConeGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  PlaneGeometry,
  SphereGeometry,
  type BufferGeometry,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

/** Shapes of unit size (radius 1, edge 1), shared by everything that scales them; cylinder and cone along z. */
export const unitBox = new BoxGeometry(1, 1, 1);
export const unitCylinder = new CylinderGeometry(1, 1, 1, 40).rotateX(Math.PI / 2);
export const unitCone = new ConeGeometry(1, 1, 40).rotateX(Math.PI / 2);
export const unitPlane = new PlaneGeometry(1, 1);
export const unitSphere = new SphereGeometry(1, 32, 20).rotateX(Math.PI / 2);
/** A unit sphere with fewer vertices, for spheres that look small. */
export const smallSphere = new SphereGeometry(1, 16, 10).rotateX(Math.PI / 2);

const capsules = new Map<number, BufferGeometry>();

/** Returns a capsule of radius 1 along z whose cylinder has this length. */
export function createCapsule(length: number): BufferGeometry {
  let geometry = capsules.get(length);
  if (!geometry) {
    geometry = new CapsuleGeometry(1, length, 12, 32).rotateX(Math.PI / 2);
    capsules.set(length, geometry);
  }
  return geometry;
}

/**
 * Returns three cylinders along x, y and z in red, green and blue, as RViz's Axes; m. Like RViz, this uses the radius
 * as the thickness of the arms, so that axes of length 1 and radius 0.1 are ten times as long as they are thick.
 */
export function createAxes(length: number, radius: number, segments: number): BufferGeometry {
  const createArm = (): BufferGeometry => createRod(segments).scale(length, radius, radius);
  return mergeGeometries([
    paint(createArm(), 1, 0, 0),
    paint(createArm().rotateZ(Math.PI / 2), 0, 1, 0),
    paint(createArm().rotateY(-Math.PI / 2), 0, 0, 1),
  ]);
}

/**
 * Returns a white rod of one meter from the origin along x, with a diameter of one meter. It is closed at one end only,
 * because the other is hidden.
 */
export function createRod(segments: number, closedAt: "origin" | "end" = "end"): BufferGeometry {
  const isOpen = true;
  const tube = new CylinderGeometry(0.5, 0.5, 1, segments, 1, isOpen).rotateZ(-Math.PI / 2).translate(0.5, 0, 0);
  const disc = new CircleGeometry(0.5, segments).rotateY(Math.PI / 2);
  if (closedAt === "end") disc.translate(1, 0, 0);
  else disc.rotateZ(Math.PI);
  return paint(mergeGeometries([tube, disc]), 1, 1, 1);
}

/** Returns a white cone with its base, one meter in diameter, at the origin, and its tip one meter along x. */
export function createCone(segments: number): BufferGeometry {
  return paint(new ConeGeometry(0.5, 1, segments).rotateZ(-Math.PI / 2).translate(0.5, 0, 0), 1, 1, 1);
}

/** Returns a white sphere with a diameter of one meter. */
export function createSphere(segments: number): BufferGeometry {
  return paint(new SphereGeometry(0.5, segments, Math.ceil(segments / 2)).rotateX(Math.PI / 2), 1, 1, 1);
}

/** Returns a closed white cylinder along z, one meter long and one meter in diameter. */
export function createCylinder(segments: number): BufferGeometry {
  return paint(new CylinderGeometry(0.5, 0.5, 1, segments).rotateX(Math.PI / 2), 1, 1, 1);
}

/** Returns a white unit cube. */
export function createCube(): BufferGeometry {
  return paint(new BoxGeometry(1, 1, 1), 1, 1, 1);
}

/** Gives all vertices the same color, 0 to 1. */
export function paint(geometry: BufferGeometry, r: number, g: number, b: number): BufferGeometry {
  const count = geometry.getAttribute("position").count;
  const colors = new Float32Array(count * 3);
  for (let i = 0; i < count; i++) colors.set([r, g, b], i * 3);
  return geometry.setAttribute("color", new Float32BufferAttribute(colors, 3));
}
