/** Part of a surface's colour that is seen even where the light at the camera does not reach it. */
export const AMBIENT = 0.2;

/** The source of light: RViz's at the camera, a soft one there, a studio, or the lights of a world. */
export type Lighting = "Camera" | "Soft" | "Studio" | "World";

/** Whether lamps in the scene shine on surfaces. */
export function standsInScene(lighting: Lighting): boolean {
  return lighting === "Studio" || lighting === "World";
}

/**
 * GLSL: `byCamera` is RViz's light, which shows a surface that faces the camera in exactly its colour; `softly` that of a
 * lamp above the viewer's left shoulder, of a sky, and of the sky's reflection. That reflection is what tells the shape of
 * a black surface. `normal` is in the frame of the camera, so neither lamps nor shadows have to be computed: it takes a
 * software renderer no longer than RViz's light.
 */
export const SURFACE_LIGHT = /* glsl */ `
  vec3 byCamera(vec3 color, float facing) {
    return color * (${AMBIENT.toFixed(2)} + ${(1 - AMBIENT).toFixed(2)} * max(0.0, facing));
  }
  vec3 reflected(vec3 color, vec3 normal) {
    float away = 1.0 - max(0.0, normal.z);
    float sky = smoothstep(-0.6, 1.0, 2.0 * normal.z * (normal.y - 0.3 * normal.x));
    float gleam = max(0.0, dot(normal, vec3(-0.19, 0.28, 0.94)));
    float share = (0.2 + 0.4 * away * away * away) * (0.35 + 0.65 * sky) + 0.13 * pow(gleam, 9.0);
    return color + share * (1.0 - min(color, vec3(1.0)));
  }
  vec3 softly(vec3 color, vec3 normal) {
    float lamp = max(0.0, dot(normal, vec3(-0.36, 0.52, 0.775)));
    return reflected(color * (0.32 + 0.16 * normal.y + 0.58 * lamp), normal);
  }
`;
