import { Box3, DirectionalLight, Mesh, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { enableShadows, StudioLight } from "../src/scene/studio-light";

describe("the studio", () => {
  function partsOf(studio: StudioLight): { lamp: DirectionalLight; ground: Mesh } {
    const lamp = studio.root.children.find((object) => object instanceof DirectionalLight);
    const ground = studio.root.children.find((object): object is Mesh => object instanceof Mesh);
    if (!lamp || !ground) throw new Error("no lamp, or no ground");
    return { lamp, ground };
  }

  it("has a ground below the objects, and shadows of their size", () => {
    for (const size of [0.01, 1, 100]) {
      const studio = new StudioLight();
      const { lamp, ground } = partsOf(studio);
      studio.update(new Box3(new Vector3(0, 0, 0), new Vector3(size, size, size)), -size);
      expect(ground.position.z).toBe(-size);
      expect(ground.visible).toBe(true);
      const { near, far, right } = lamp.shadow.camera;
      const distance = lamp.position.distanceTo(lamp.target.position);
      expect(near).toBeLessThan(distance - right);
      expect(far).toBeGreaterThan(distance + right);
      expect(right).toBeGreaterThan(Math.sqrt(3) * size / 2);
      expect(right).toBeLessThan(2 * size);
    }
  });

  it("gives a robot's shadow softer edges than a world's", () => {
    const sun = new DirectionalLight();
    enableShadows(sun);
    expect(partsOf(new StudioLight()).lamp.shadow.radius).toBeGreaterThan(2 * sun.shadow.radius);
  });

  it("has no ground while it is empty", () => {
    const studio = new StudioLight();
    studio.update(new Box3(), 0);
    expect(partsOf(studio).ground.visible).toBe(false);
  });
});
