import { Color, DataTexture, Fog, FogExp2, Scene } from "three";
import { describe, expect, it } from "vitest";
import { SkyAndFog } from "../src/scene/surroundings";

const NONE = { background: null, daylight: null, fog: null };
const FOG = { color: [1, 1, 1], start: 2, end: 9, density: null };

describe("sky and fog", () => {
  it("exist for worlds that have them, and are created once", () => {
    const scene = new Scene();
    const skyAndFog = new SkyAndFog(scene);
    skyAndFog.apply({ ...NONE, daylight: 1, fog: FOG }, false);
    const { background, fog } = scene;
    expect(background).toBeInstanceOf(DataTexture);
    expect(fog).toBeInstanceOf(Fog);
    expect(fog).toMatchObject({ near: 2, far: 9 });
    skyAndFog.apply({ ...NONE, daylight: 1, fog: { ...FOG } }, false);
    expect(scene.background).toBe(background);
    expect(scene.fog).toBe(fog);
    skyAndFog.apply({ ...NONE, daylight: 0, fog: { ...FOG, density: 0.5 } }, false);
    expect(scene.background).not.toBe(background);
    expect(scene.fog).toBeInstanceOf(FogExp2);
    skyAndFog.apply(NONE, false);
    expect([scene.background, scene.fog]).toEqual([null, null]);
  });

  it("have one color for an orthographic camera", () => {
    const scene = new Scene();
    new SkyAndFog(scene).apply({ ...NONE, daylight: 1 }, true);
    expect(scene.background).toBeInstanceOf(Color);
  });

  it("are a backdrop in a studio, with its color at the zenith and a brighter horizon", () => {
    const scene = new Scene();
    const skyAndFog = new SkyAndFog(scene);
    skyAndFog.apply({ ...NONE, backdrop: "#303030" }, false);
    const { data } = (scene.background as DataTexture).image as { data: Uint8Array };
    const [horizon = 0, zenith = 0] = [data[data.length / 2], data[data.length - 4]];
    expect(horizon).toBeGreaterThan(zenith + 20);
    skyAndFog.apply({ ...NONE, backdrop: "#303030" }, true);
    expect(scene.background).toBeNull();
  });
});
