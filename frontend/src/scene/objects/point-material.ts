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

// A point is drawn on a square that faces the camera and contains it. `place` is the position of a fragment on that
// square, -1 to 1; `halfSide` is half the side of the square, m. Solid styles trace the ray through the fragment into
// the point. All other values are constant over a point and therefore flat: interpolation makes software renderers a
// fifth slower per point.
const VERTEX_SHADER = /* glsl */ `
  uniform vec3 extent;
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
    out vec2 place;
  #endif
  flat out vec4 vColor;
  #ifdef SOLID
    flat out vec3 middle;
    flat out vec2 halfSide;
    flat out vec3 side;
  #else
    vec2 halfSide;
    vec3 side;
  #endif

  void main() {
    #ifdef TINTED
      vColor = vec4(tint.rgb, tint.a * alpha);
    #else
      vColor = vec4(color, alpha);
    #endif
    side = perDepth > 0.0 ? vec3(perDepth * max(0.0, position.z)) : extent;
    vec4 eye = modelViewMatrix * vec4(position, 1.0);
    #ifdef SOLID
      middle = eye.xyz;
    #endif
    gl_Position = projectionMatrix * eye;
    // Pixels of a meter there, along x and y of the screen.
    vec2 scale = vec2(projectionMatrix[0][0], projectionMatrix[1][1]) * 0.5 * viewport / gl_Position.w;
    #if defined(FIXED)
      halfSide = vec2(pixels * 0.5) / scale;
    #elif defined(SOLID)
      halfSide = vec2(length(side) * 0.5 * REACH);
    #else
      halfSide = side.xy * 0.5;
    #endif
    halfSide = max(halfSide, vec2(0.5) / scale);
    #ifdef QUADS
      place = corner;
      gl_Position = projectionMatrix * vec4(eye.xyz + vec3(corner * halfSide, 0.0), 1.0);
    #else
      gl_PointSize = max(halfSide.x * scale.x, halfSide.y * scale.y) * 2.0;
      halfSide = vec2(gl_PointSize * 0.5) / scale;
    #endif
  }
`;

const FRAGMENT_SHADER = /* glsl */ `
  precision highp float;
  uniform mat4 projectionMatrix;
  uniform mat4 modelViewMatrix;
  flat in vec4 vColor;
  #ifdef SOLID
    flat in vec3 middle;
    flat in vec2 halfSide;
    flat in vec3 side;
  #endif
  #ifdef QUADS
    in vec2 place;
  #endif
  out vec4 fragment;

  void main() {
    #ifdef QUADS
      vec2 at = place;
    #else
      vec2 at = vec2(gl_PointCoord.x, 1.0 - gl_PointCoord.y) * 2.0 - 1.0;
    #endif
    vec3 paint = vColor.rgb;
    #ifdef ROUND
      float square = dot(at, at);
      if (square > 1.0) discard;
      paint *= 0.4 + 0.6 * sqrt(1.0 - square);
    #endif
    #ifdef RIMMED
      vec2 edge = smoothstep(vec2(0.9), vec2(0.96), abs(at));
      paint += (length(paint) > 0.5 ? -0.2 : 0.2) * max(edge.x, edge.y);
    #endif
    #ifdef SOLID
      vec3 through = middle + vec3(at * halfSide, 0.0);
      bool parallel = projectionMatrix[3][3] == 1.0;
      mat3 turn = mat3(modelViewMatrix);
      // The ray in the frame of the points, from the middle of this one.
      vec3 ray = (parallel ? vec3(0.0, 0.0, -1.0) : through) * turn;
      ray += vec3(lessThan(abs(ray), vec3(1e-6))) * 2e-6; // keep the ray from being parallel to a side
      vec3 from = ((parallel ? through : vec3(0.0)) - middle) * turn;
      float reached;
      #ifdef FLAT
        reached = -from.z / ray.z;
        vec3 hit = from + ray * reached;
        if (any(greaterThan(abs(hit.xy), side.xy * 0.5))) discard;
      #else
        vec3 toward = -sign(ray) * side * 0.5;
        vec3 enter = (toward - from) / ray;
        vec3 leave = (-toward - from) / ray;
        reached = max(max(enter.x, enter.y), enter.z);
        if (reached > min(min(leave.x, leave.y), leave.z)) discard;
        // As bright as RViz draws the six sides.
        vec3 bright = vec3(ray.x < 0.0 ? 0.9 : 0.5, ray.y < 0.0 ? 0.6 : 0.6, ray.z < 0.0 ? 1.0 : 0.4);
        paint *= reached == enter.z ? bright.z : reached == enter.y ? bright.y : bright.x;
      #endif
      float depth = parallel ? through.z - reached : through.z * reached;
      vec2 clip = vec2(projectionMatrix[2][2] * depth + projectionMatrix[3][2], parallel ? 1.0 : -depth);
      gl_FragDepth = clamp(clip.x / clip.y * 0.5 + 0.5, 0.0, 1.0);
    #endif
    fragment = vec4(clamp(paint, 0.0, 1.0), vColor.a);
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
      extent: { value: new Vector3() },
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
  (uniforms["extent"]?.value as Vector3).fromArray(look.size);
  (uniforms["color"]?.value as Color).set(look.color);
  for (const name of ["pixels", "perDepth", "alpha"] as const) {
    const uniform = uniforms[name];
    if (uniform) uniform.value = look[name];
  }
}
