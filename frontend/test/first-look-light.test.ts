import { BoxGeometry, ColorManagement, Mesh, Vector3, type Color, type DataTexture } from "three";
import { describe, expect, it } from "vitest";
import { Backdrop } from "../src/scene/backdrop";
import { ContactShadow } from "../src/scene/contact-shadow";
import { createFadedColors } from "../src/scene/displays/grid-lines";
import { listFramingPoints, getSamples } from "../src/scene/robot/surface-samples";

function boxAt(x: number, z: number): Mesh {
  const mesh = new Mesh(new BoxGeometry(1, 1, 1));
  mesh.position.set(x, 0, z);
  mesh.updateMatrixWorld();
  return mesh;
}

/** Returns the darkness of the ground at a point, 0 to 255. */
function shadeAt(shadow: ContactShadow, x: number, y: number): number {
  const { position, scale, material } = shadow.ground;
  const { data, width } = (material.map as DataTexture).image as { data: Uint8Array; width: number };
  const [column, row] = [(x - position.x) / scale.x, (y - position.y) / scale.y].map((share) => Math.floor((share + 0.5) * width)) as [number, number];
  return data[4 * (row * width + column) + 3] ?? 0;
}

describe("sample points of a surface", () => {
  it("lie on all sides of it and represent its whole area", () => {
    const { points, area } = getSamples(new BoxGeometry(1, 2, 3));
    const half = [0.5, 1, 1.5];
    const sides = new Set<string>();
    for (let i = 0; i < points.length; i += 3) {
      const point = [...points.subarray(i, i + 3)];
      const parts = point.map((value, axis) => value / (half[axis] ?? 1));
      expect(Math.max(...parts.map(Math.abs))).toBeCloseTo(1, 5);
      const axis = parts.findIndex((part) => Math.abs(Math.abs(part) - 1) < 1e-5);
      sides.add(`${axis}${Math.sign(parts[axis] ?? 0)}`);
    }
    expect(sides.size).toBe(6);
    expect((area * points.length) / 3).toBeCloseTo(22, 3);
  });

  it("follow the pose of the mesh", () => {
    for (const [x] of listFramingPoints(boxAt(7, 0))) expect(Math.abs(x - 7)).toBeLessThanOrEqual(0.5 + 1e-5);
  });
});

describe("the shadow on the ground", () => {
  it("is dark below objects, fades out next to them, and ends", () => {
    const shadow = new ContactShadow();
    shadow.update([boxAt(3, 0.5)], 0);
    expect(shadow.ground.position).toEqual(new Vector3(3, 0, 0));
    const [shadeBelow, shadeBeside, shadeFar] = [3, 3.61, 3.8].map((x) => shadeAt(shadow, x, 0)) as [number, number, number];
    expect(shadeBelow).toBeGreaterThan(100);
    expect(shadeBeside).toBeLessThan(0.8 * shadeBelow);
    expect(shadeFar).toBe(0);
  });

  it("is fainter below floating objects", () => {
    const [standingShade, hoveringShade] = [0.5, 1.5].map((z) => {
      const shadow = new ContactShadow();
      shadow.update([boxAt(0, z)], 0);
      return shadeAt(shadow, 0, 0);
    }) as [number, number];
    expect(hoveringShade).toBeLessThan(standingShade * 0.8);
    expect(hoveringShade).toBeGreaterThan(0);
  });

  it("follows moving objects", () => {
    const shadow = new ContactShadow();
    const box = boxAt(0, 0.5);
    shadow.update([box], 0);
    box.position.x = 5;
    box.updateMatrixWorld();
    shadow.update([box], 0);
    expect(shadow.ground.position.x).toBe(5);
    shadow.update([], 0);
    expect(shadow.ground.visible).toBe(false);
  });
});

it("lines of a grid fade out towards its edge", () => {
  const shades = createFadedColors(new Float32Array([0, 0, 0, 1, 0, 0, 2, 0, 0, 4, 0, 0]));
  expect([shades[3], shades[7], shades[11], shades[15]]).toEqual([1, 1 - 1 / 16, 0.75, 0]);
});

it("the ground of both themes is darker than white robots and brighter than black ones", () => {
  for (const theme of ["light", "dark"] as const) {
    ColorManagement.enabled = false; // as in the page
    const backdrop = new Backdrop();
    backdrop.theme = theme;
    const grayOf = (name: string): number => {
      const { r, g, b } = backdrop.root.material.uniforms[name]?.value as Color;
      return (r + g + b) / 3;
    };
    expect(grayOf("ground")).toBeGreaterThan(0.3);
    expect(grayOf("ground")).toBeLessThan(0.8);
    expect(grayOf("horizon")).toBeGreaterThan(grayOf("ground"));
  }
});
