/** Part of a surface's colour that is seen even where the light at the camera does not reach it. */
export const AMBIENT = 0.2;

/** The source of light: the camera, a studio, or the lights of a world. */
export type Lighting = "Camera" | "Studio" | "World";
