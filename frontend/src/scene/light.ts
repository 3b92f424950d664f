/** The share of a surface's color that is visible even where the camera's light does not reach. */
export const AMBIENT_SHARE = 0.2;

/** The lighting: RViz's light at the camera, a soft one at the camera, a studio, or the lights of a world. */
export type Lighting = "Camera" | "Soft" | "Studio" | "World";

/** Whether the lighting consists of lights in the scene. */
export function usesSceneLights(lighting: Lighting): boolean {
  return lighting === "Studio" || lighting === "World";
}

/**
 * GLSL functions for light that moves with the camera. `applyCameraLight` is RViz's light, which shows a surface facing
 * the camera in exactly its color. `applySoftLight` is a lamp above the viewer's left shoulder, a sky, and the sky's
 * reflection, which reveals the shape of black surfaces. `normal` is in the camera's frame, so that neither lights nor
 * shadows have to be computed; on a software renderer this is as fast as RViz's light.
 */
export const SURFACE_LIGHT = /* glsl */ `
  vec3 applyCameraLight(vec3 color, float facingCosine) {
    return color * (${AMBIENT_SHARE.toFixed(2)} + ${(1 - AMBIENT_SHARE).toFixed(2)} * max(0.0, facingCosine));
  }
  vec3 addSkyReflection(vec3 color, vec3 normal) {
    float grazing = 1.0 - max(0.0, normal.z);
    float sky = smoothstep(-0.6, 1.0, 2.0 * normal.z * (normal.y - 0.3 * normal.x));
    float highlight = max(0.0, dot(normal, vec3(-0.19, 0.28, 0.94)));
    float reflectance = (0.2 + 0.4 * grazing * grazing * grazing) * (0.35 + 0.65 * sky) + 0.13 * pow(highlight, 9.0);
    return color + reflectance * (1.0 - min(color, vec3(1.0)));
  }
  vec3 applySoftLight(vec3 color, vec3 normal) {
    float lamp = max(0.0, dot(normal, vec3(-0.36, 0.52, 0.775)));
    return addSkyReflection(color * (0.32 + 0.16 * normal.y + 0.58 * lamp), normal);
  }
`;
