import { Texture } from "three";
import { describe, expect, it } from "vitest";
import { SharedTextures } from "../src/scene/meshes/shared-textures";

describe("shared textures", () => {
  it("are loaded once and disposed of after the last release", async () => {
    let loads = 0;
    let disposed = 0;
    const textures = new SharedTextures(() => {
      loads++;
      const texture = new Texture();
      texture.addEventListener("dispose", () => disposed++);
      return Promise.resolve(texture);
    });
    const [first, second] = await Promise.all([textures.acquire("a"), textures.acquire("a")]);
    expect(first).toBe(second);
    textures.release("a");
    await Promise.resolve();
    expect([loads, disposed]).toEqual([1, 0]);
    textures.release("a");
    await Promise.resolve();
    expect([loads, disposed]).toEqual([1, 1]);
    await textures.acquire("a");
    expect(loads).toBe(2);
  });
});
