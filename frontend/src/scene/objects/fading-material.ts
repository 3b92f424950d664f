import { MeshLambertMaterial, type MeshLambertMaterialParameters } from "three";

/** Instanced attribute: how far towards grey (0 to 1), and alpha. */
export const FADE_ATTRIBUTE = "fade";

/** A lit material whose instances fade to grey and then away, as RViz's old frames do. */
export function fadingMaterial(parameters: MeshLambertMaterialParameters): MeshLambertMaterial {
  const material = new MeshLambertMaterial(parameters);
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nattribute vec2 fade;\nvarying vec2 vFade;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nvFade = fade;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec2 vFade;")
      .replace(
        "#include <color_fragment>",
        "#include <color_fragment>\ndiffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.7), vFade.x);\ndiffuseColor.a *= vFade.y;",
      );
  };
  return material;
}
