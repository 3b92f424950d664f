import { Matrix4, PerspectiveCamera } from "three";
import { describe, expect, it } from "vitest";
import type { WorldWater } from "../src/protocol";
import { WaterSurface, computeParticle } from "../src/scene/displays/world-water";
import surfaces from "./water-surfaces.json";

/** Returns a camera that looks along x and down, at the origin. */
function createCamera(distance: number): PerspectiveCamera {
  const camera = new PerspectiveCamera();
  camera.up.set(0, 0, 1);
  camera.position.set(-distance, 0, distance);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  return camera;
}

function readVertices(surface: WaterSurface): number[][] {
  const positions = surface.root.geometry.getAttribute("position");
  return Array.from({ length: positions.count }, (_, i) => [positions.getX(i), positions.getY(i), positions.getZ(i)]);
}

describe("the surface of water", () => {
  it("is the one on which the simulation floats bodies", () => {
    const particle = new Float64Array(5);
    expect(surfaces).toHaveLength(6);
    for (const { water, seconds, rest_points, surface } of surfaces) {
      rest_points.forEach(([x = 0, y = 0], i) => {
        computeParticle(water as WorldWater, x, y, seconds, particle);
        particle.forEach((value, k) => expect(value).toBeCloseTo(surface[i]?.[k] ?? NaN, 4));
      });
    }
  });

  it("is flat without waves, around the view, and larger from far away", () => {
    const water: WorldWater = { kind: "world_water", level: 0.5, growth_time: 0, waves: [] };
    const surface = new WaterSurface();
    const findHalfSide = (): number => Math.max(...readVertices(surface).map(([x = 0]) => x));
    surface.update(water, 3, createCamera(5), new Matrix4());
    expect(new Set(readVertices(surface).map(([, , z]) => z))).toEqual(new Set([0.5]));
    const nearHalfSide = findHalfSide();
    surface.update(water, 3, createCamera(1000), new Matrix4());
    expect(nearHalfSide).toBeGreaterThan(30);
    expect(nearHalfSide).toBeLessThan(60);
    expect(findHalfSide()).toBeLessThanOrEqual(500);
    expect(findHalfSide()).toBeGreaterThan(2 * nearHalfSide);
  });

  it("is computed again only if time, water or view changed", () => {
    const water = surfaces[0]?.water as WorldWater;
    const surface = new WaterSurface();
    const positions = surface.root.geometry.getAttribute("position");
    const update = (seconds: number, camera: PerspectiveCamera): number => {
      surface.update(water, seconds, camera, new Matrix4());
      return "version" in positions ? positions.version : NaN;
    };
    const camera = createCamera(10);
    const version = update(2, camera);
    expect(update(2, camera)).toBe(version);
    expect(update(2.1, camera)).toBe(version + 1);
    expect(update(2.1, createCamera(100))).toBe(version + 2);
  });
});
