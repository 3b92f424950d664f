import { Texture } from "three";
import { describe, expect, it } from "vitest";
import { SharedTextures } from "../src/scene/meshes/shared-textures";

describe("shared textures", () => {
  it("are loaded once and disposed of after the last user", async () => {
    let loads = 0;
    let disposed = 0;
    const textures = new SharedTextures(() => {
      loads++;
      const texture = new Texture();
      texture.addEventListener("dispose", () => disposed++);
      return Promise.resolve(texture);
    });
    const [first, second] = await Promise.all([textures.take("a"), textures.take("a")]);
    expect(first).toBe(second);
    textures.giveBack("a");
    await Promise.resolve();
    expect([loads, disposed]).toEqual([1, 0]);
    textures.giveBack("a");
    await Promise.resolve();
    expect([loads, disposed]).toEqual([1, 1]);
    await textures.take("a");
    expect(loads).toBe(2);
  });
});
