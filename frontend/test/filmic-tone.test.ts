import { MeshLambertMaterial, ShaderLib } from "three";
import { expect, test } from "vitest";
import { applyFilmicTone } from "../src/scene/filmic-tone";
import { MaterialPool, type Look } from "../src/scene/materials";

const LOOK: Look = { color: [1, 1, 1], alpha: 1, map: null, hasVertexColors: false, isDoubleSided: true };

test("the tone mapping is inserted into the shader at three.js's own", () => {
  const material = applyFilmicTone(new MeshLambertMaterial());
  const shader = { ...ShaderLib.lambert };
  material.onBeforeCompile(shader as never, null as never);
  expect(shader.fragmentShader).not.toContain("tonemapping_fragment");
  expect(shader.fragmentShader).toContain("vec3 shoulder");
});

test("only the studio has it: the light of cameras and worlds shows colors unchanged", () => {
  const pool = new MaterialPool();
  const filmicByLighting = new Map(
    (["Camera", "Studio", "World"] as const).map((lighting) => {
      pool.lighting = lighting;
      return [lighting, pool.get(LOOK).customProgramCacheKey() === "filmic"];
    }),
  );
  expect(Object.fromEntries(filmicByLighting)).toEqual({ Camera: false, Studio: true, World: false });
});
