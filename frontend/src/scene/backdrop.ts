import { Color, Matrix4, Mesh, PlaneGeometry, ShaderMaterial } from "three";
import type { Theme } from "../state/theme";

/**
 * The number of squares along each side; colors are computed at their corners and interpolated, which is not visible.
 */
const SQUARES_PER_SIDE = 24;
/** The render order of the backdrop: drawn before everything else. */
const RENDER_ORDER = -1000;

/** Colors as 0xrrggbb; `ground` is the color straight down. */
interface SkyColors {
  readonly zenith: number;
  readonly horizon: number;
  readonly ground: number;
}

/** The colors are of medium brightness where robots stand, so that both black and white robots stand out. */
const SKY_COLORS: Readonly<Record<Theme, SkyColors>> = {
  light: { zenith: 0xbccbda, horizon: 0xeef2f5, ground: 0xaeb7c0 },
  dark: { zenith: 0x39424d, horizon: 0x77828e, ground: 0x545d67 },
};

const VERTEX_SHADER = /* glsl */ `
  uniform mat4 unprojected;
  uniform mat4 toWorld;
  uniform vec3 zenith, horizon, ground;
  varying vec3 skyColor;
  void main() {
    vec4 viewPoint = unprojected * vec4(position.xy, 1.0, 1.0);
    vec3 ray = isOrthographic ? vec3(0.0, 0.0, -1.0) : viewPoint.xyz / viewPoint.w;
    float up = normalize(mat3(toWorld) * ray).z;
    skyColor = up > 0.0 ? mix(horizon, zenith, pow(up, 0.7)) : mix(horizon, ground, smoothstep(0.0, 0.75, pow(-up, 0.8)));
    gl_Position = vec4(position.xy, 1.0, 1.0);
  }
`;
const FRAGMENT_SHADER = /* glsl */ `
  varying vec3 skyColor;
  void main() { gl_FragColor = vec4(skyColor, 1.0); }
`;

/**
 * A sky and a ground behind everything, which meet at a bright horizon. Colors are computed at few points, so that
 * without a GPU they cost little more than a plain background.
 */
export class Backdrop {
  readonly root: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly uniforms = {
    unprojected: { value: new Matrix4() },
    toWorld: { value: new Matrix4() },
    zenith: { value: new Color() },
    horizon: { value: new Color() },
    ground: { value: new Color() },
  };

  constructor() {
    const style = { vertexShader: VERTEX_SHADER, fragmentShader: FRAGMENT_SHADER, depthTest: false, depthWrite: false };
    this.root = new Mesh(new PlaneGeometry(2, 2, SQUARES_PER_SIDE, SQUARES_PER_SIDE), new ShaderMaterial({ ...style, uniforms: this.uniforms }));
    this.root.renderOrder = RENDER_ORDER;
    this.root.frustumCulled = false;
    this.root.visible = false;
    this.root.onBeforeRender = (_renderer, _scene, camera) => {
      this.uniforms.unprojected.value.copy(camera.projectionMatrixInverse);
      this.uniforms.toWorld.value.copy(camera.matrixWorld);
    };
  }

  set theme(theme: Theme) {
    const { zenith, horizon, ground } = SKY_COLORS[theme];
    this.uniforms.zenith.value.setHex(zenith);
    this.uniforms.horizon.value.setHex(horizon);
    this.uniforms.ground.value.setHex(ground);
  }
}
