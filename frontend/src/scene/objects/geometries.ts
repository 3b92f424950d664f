import {
  BoxGeometry,
  CapsuleGeometry,
  CircleGeometry,
  ConeGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  SphereGeometry,
  type BufferGeometry,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

/** Shapes of size one, shared by everything that scales them; cylinder along z. */
export const unitBox = new BoxGeometry(1, 1, 1);
export const unitCylinder = new CylinderGeometry(1, 1, 1, 40).rotateX(Math.PI / 2);
export const unitSphere = new SphereGeometry(1, 32, 20).rotateX(Math.PI / 2);

const capsules = new Map<number, BufferGeometry>();

/** A capsule of radius 1 along z whose cylinder is `length` long. */
export function capsule(length: number): BufferGeometry {
  let geometry = capsules.get(length);
  if (!geometry) {
    geometry = new CapsuleGeometry(1, length, 12, 32).rotateX(Math.PI / 2);
    capsules.set(length, geometry);
  }
  return geometry;
}

/** Three cylinders along x, y and z in red, green and blue, as RViz's Axes. Metres. */
export function axesGeometry(length: number, radius: number, segments: number): BufferGeometry {
  const arm = (): BufferGeometry => mergeGeometries([tube(radius, length, segments), disc(radius, length, segments)]);
  return mergeGeometries([
    paint(arm().rotateY(Math.PI / 2), 1, 0, 0),
    paint(arm().rotateX(-Math.PI / 2), 0, 1, 0),
    paint(arm(), 0, 0, 1),
  ]);
}

/** RViz's arrow from a frame to its parent: from the origin one metre along z, radius one; its ends are never seen. */
export function arrowShaftGeometry(segments: number): BufferGeometry {
  return paint(tube(1, 1, segments), 0.8, 0.8, 0.3);
}

/** Base at the origin, tip one metre along z, radius one. */
export function arrowHeadGeometry(segments: number): BufferGeometry {
  return paint(new ConeGeometry(1, 1, segments).rotateX(Math.PI / 2).translate(0, 0, 0.5), 1, 0.1, 0.6);
}

function tube(radius: number, length: number, segments: number): BufferGeometry {
  const open = true;
  return new CylinderGeometry(radius, radius, length, segments, 1, open).rotateX(Math.PI / 2).translate(0, 0, length / 2);
}

function disc(radius: number, z: number, segments: number): BufferGeometry {
  return new CircleGeometry(radius, segments).translate(0, 0, z);
}

function paint(geometry: BufferGeometry, r: number, g: number, b: number): BufferGeometry {
  const count = geometry.getAttribute("position").count;
  const colors = new Float32Array(count * 3);
  for (let i = 0; i < count; i++) colors.set([r, g, b], i * 3);
  return geometry.setAttribute("color", new Float32BufferAttribute(colors, 3));
}
