import { Color, GLSL3, ShaderMaterial, Vector3 } from "three";

/** RViz's styles of points. */
export type PointStyle = "Points" | "Squares" | "Flat Squares" | "Spheres" | "Boxes" | "Tiles";

/** How points are drawn. */
export interface PointLook {
  style: PointStyle;
  /** Sizes along x, y and z of the points' frame, m; styles that face the camera use the first two. */
  size: readonly [number, number, number];
  /** The size of points of the style Points, pixels. */
  pixels: number;
  /** Size per depth along z of the points' frame, m per m; 0 to use `size`. */
  perDepth: number;
  /** The color of points without colors of their own. */
  color: string;
  alpha: number;
}

/** A variant of the shader, which is compiled once for all batches that use it. */
export interface PointVariant {
  style: PointStyle;
  /** Whether points have colors of their own. */
  isTinted: boolean;
  /** Whether each point is a quad; otherwise it is a point of the graphics library, whose size is limited. */
  hasQuads: boolean;
  isTranslucent: boolean;
}

// A point is drawn on a square that faces the camera and contains it. `squarePosition` is the position of a fragment on
// that square, -1 to 1; `halfSide` is half the side of the square, m. Solid styles trace the ray through the fragment
// into the point. All other values are constant over a point and therefore flat: interpolation makes software renderers
// a fifth slower per point.
const VERTEX_SHADER = /* glsl */ `
  uniform vec3 size;
  uniform vec3 color;
  uniform float pixels;
  uniform float perDepth;
  uniform float alpha;
  uniform vec2 viewport;
  #ifdef TINTED
    in vec4 tint;
  #endif
  #ifdef QUADS
    in vec2 corner;
    out vec2 vSquarePosition;
  #endif
  flat out vec4 vColor;
  #ifdef SOLID
    flat out vec3 center;
    flat out vec2 halfSide;
    flat out vec3 pointSize;
  #else
    vec2 halfSide;
    vec3 pointSize;
  #endif

  void main() {
    #ifdef TINTED
      vColor = vec4(tint.rgb, tint.a * alpha);
    #else
      vColor = vec4(color, alpha);
    #endif
    pointSize = perDepth > 0.0 ? vec3(perDepth * max(0.0, position.z)) : size;
    vec4 viewPosition = modelViewMatrix * vec4(position, 1.0);
    #ifdef SOLID
      center = viewPosition.xyz;
    #endif
    gl_Position = projectionMatrix * viewPosition;
    // Pixels of a meter there, along x and y of the screen.
    vec2 pixelsPerMeter = vec2(projectionMatrix[0][0], projectionMatrix[1][1]) * 0.5 * viewport / gl_Position.w;
    #if defined(FIXED)
      halfSide = vec2(pixels * 0.5) / pixelsPerMeter;
    #elif defined(SOLID)
      halfSide = vec2(length(pointSize) * 0.5 * REACH);
    #else
      halfSide = pointSize.xy * 0.5;
    #endif
    halfSide = max(halfSide, vec2(0.5) / pixelsPerMeter);
    #ifdef QUADS
      vSquarePosition = corner;
      gl_Position = projectionMatrix * vec4(viewPosition.xyz + vec3(corner * halfSide, 0.0), 1.0);
    #else
      gl_PointSize = max(halfSide.x * pixelsPerMeter.x, halfSide.y * pixelsPerMeter.y) * 2.0;
      halfSide = vec2(gl_PointSize * 0.5) / pixelsPerMeter;
    #endif
  }
`;

const FRAGMENT_SHADER = /* glsl */ `
  precision highp float;
  uniform mat4 projectionMatrix;
  uniform mat4 modelViewMatrix;
  flat in vec4 vColor;
  #ifdef SOLID
    flat in vec3 center;
    flat in vec2 halfSide;
    flat in vec3 pointSize;
  #endif
  #ifdef QUADS
    in vec2 vSquarePosition;
  #endif
  out vec4 fragmentColor;

  void main() {
    #ifdef QUADS
      vec2 squarePosition = vSquarePosition;
    #else
      vec2 squarePosition = vec2(gl_PointCoord.x, 1.0 - gl_PointCoord.y) * 2.0 - 1.0;
    #endif
    vec3 pointColor = vColor.rgb;
    #ifdef ROUND
      float squaredRadius = dot(squarePosition, squarePosition);
      if (squaredRadius > 1.0) discard;
      pointColor *= 0.4 + 0.6 * sqrt(1.0 - squaredRadius);
    #endif
    #ifdef RIMMED
      vec2 rim = smoothstep(vec2(0.9), vec2(0.96), abs(squarePosition));
      pointColor += (length(pointColor) > 0.5 ? -0.2 : 0.2) * max(rim.x, rim.y);
    #endif
    #ifdef SOLID
      vec3 squarePoint = center + vec3(squarePosition * halfSide, 0.0);
      bool hasParallelRays = projectionMatrix[3][3] == 1.0;
      mat3 rotation = mat3(modelViewMatrix);
      // The ray in the frame of the points, relative to the center of this one.
      vec3 rayDirection = (hasParallelRays ? vec3(0.0, 0.0, -1.0) : squarePoint) * rotation;
      rayDirection += vec3(lessThan(abs(rayDirection), vec3(1e-6))) * 2e-6; // keep the ray from being parallel to a side
      vec3 rayStart = ((hasParallelRays ? squarePoint : vec3(0.0)) - center) * rotation;
      float hitDistance;
      #ifdef FLAT
        hitDistance = -rayStart.z / rayDirection.z;
        vec3 hit = rayStart + rayDirection * hitDistance;
        if (any(greaterThan(abs(hit.xy), pointSize.xy * 0.5))) discard;
      #else
        vec3 nearSides = -sign(rayDirection) * pointSize * 0.5;
        vec3 entryDistances = (nearSides - rayStart) / rayDirection;
        vec3 exitDistances = (-nearSides - rayStart) / rayDirection;
        hitDistance = max(max(entryDistances.x, entryDistances.y), entryDistances.z);
        if (hitDistance > min(min(exitDistances.x, exitDistances.y), exitDistances.z)) discard;
        // As bright as RViz draws the six sides.
        vec3 brightness = vec3(rayDirection.x < 0.0 ? 0.9 : 0.5, rayDirection.y < 0.0 ? 0.6 : 0.6, rayDirection.z < 0.0 ? 1.0 : 0.4);
        pointColor *= hitDistance == entryDistances.z ? brightness.z : hitDistance == entryDistances.y ? brightness.y : brightness.x;
      #endif
      float depth = hasParallelRays ? squarePoint.z - hitDistance : squarePoint.z * hitDistance;
      vec2 clipPosition = vec2(projectionMatrix[2][2] * depth + projectionMatrix[3][2], hasParallelRays ? 1.0 : -depth);
      gl_FragDepth = clamp(clipPosition.x / clipPosition.y * 0.5 + 0.5, 0.0, 1.0);
    #endif
    fragmentColor = vec4(clamp(pointColor, 0.0, 1.0), vColor.a);
  }
`;

const DEFINES: Readonly<Record<PointStyle, Record<string, string>>> = {
  Points: { FIXED: "" },
  Squares: { RIMMED: "" },
  "Flat Squares": {},
  Spheres: { ROUND: "" },
  // From any direction, a box is within its bounding sphere; at the side of a wide view, that sphere appears as an
  // ellipse.
  Boxes: { SOLID: "", REACH: "1.12" },
  Tiles: { SOLID: "", FLAT: "", REACH: "1.12" },
};

/** Returns the material of a variant; `setLook` and `setViewport` set its uniforms. */
export function createPointMaterial({ style, isTinted, hasQuads, isTranslucent }: PointVariant): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX_SHADER,
    fragmentShader: FRAGMENT_SHADER,
    defines: { ...DEFINES[style], ...(isTinted && { TINTED: "" }), ...(hasQuads && { QUADS: "" }) },
    uniforms: {
      size: { value: new Vector3() },
      color: { value: new Color() },
      pixels: { value: 1 },
      perDepth: { value: 0 },
      alpha: { value: 1 },
      viewport: { value: [1, 1] },
    },
    transparent: isTranslucent,
    depthWrite: !isTranslucent,
  });
}

/** Applies the parts of a look that do not need another shader. */
export function setLook({ uniforms }: ShaderMaterial, look: PointLook): void {
  (uniforms["size"]?.value as Vector3).fromArray(look.size);
  (uniforms["color"]?.value as Color).set(look.color);
  for (const name of ["pixels", "perDepth", "alpha"] as const) {
    const uniform = uniforms[name];
    if (uniform) uniform.value = look[name];
  }
}
