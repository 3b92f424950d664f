import type { Material } from "three";

/** What a screen shows of light is this power of it. */
const GAMMA = 2.2;
/** Light up to here is darkened as film does, which deepens shades; from `SHOULDER` on it goes towards white ever more slowly. */
const TOE = 0.22;
const TOE_POWER = 1.12;
const SHOULDER = 0.532;
/** How fast it does, so that the curve has no corner. */
const ROLL_OFF = 1 / (1 - SHOULDER);

const TONE = /* glsl */ `
  {
    vec3 light = pow(max(gl_FragColor.rgb, 0.0), vec3(${GAMMA.toFixed(2)}));
    vec3 toe = ${TOE.toFixed(3)} * pow(light / ${TOE.toFixed(3)}, vec3(${TOE_POWER.toFixed(3)}));
    vec3 shoulder = 1.0 - ${(1 - SHOULDER).toFixed(4)} * exp((${SHOULDER.toFixed(4)} - light) * ${ROLL_OFF.toFixed(4)});
    light = mix(mix(toe, light, step(${TOE.toFixed(3)}, light)), shoulder, step(${SHOULDER.toFixed(4)}, light));
    gl_FragColor.rgb = pow(light, vec3(1.0 / ${GAMMA.toFixed(2)}));
  }
`;

/**
 * Has a surface shown as film would: what lamps light strongly keeps its shape and shades are deep, and shades between
 * stay as they are. It is computed where surfaces are, so marks, lines, grids and backgrounds keep their exact colours.
 */
export function filmic<T extends Material>(material: T): T {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace("#include <tonemapping_fragment>", TONE);
  };
  material.customProgramCacheKey = () => "filmic";
  return material;
}
