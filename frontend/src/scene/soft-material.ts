import type { Material } from "three";
import { SURFACE_LIGHT } from "./light";

/** Gives a material the soft light instead of the lights of the scene. */
export function softenLight<T extends Material>(material: T): T {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\n${SURFACE_LIGHT}`)
      .replace("#include <opaque_fragment>", "outgoingLight = applySoftLight(diffuseColor.rgb, normal);\n#include <opaque_fragment>");
  };
  material.customProgramCacheKey = () => "soft";
  return material;
}
