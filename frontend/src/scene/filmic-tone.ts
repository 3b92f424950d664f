import type { Material } from "three";

/** The exponent between displayed values and light. */
const GAMMA = 2.2;
/**
 * Light up to `TOE` is darkened as on film, which deepens shades; from `SHOULDER` on it approaches white ever more
 * slowly.
 */
const TOE = 0.22;
const TOE_POWER = 1.12;
const SHOULDER = 0.532;
/** The rate of that approach, chosen so that the curve is smooth at the shoulder. */
const ROLL_OFF = 1 / (1 - SHOULDER);

const TONE_SHADER = /* glsl */ `
  {
    vec3 light = pow(max(gl_FragColor.rgb, 0.0), vec3(${GAMMA.toFixed(2)}));
    vec3 toe = ${TOE.toFixed(3)} * pow(light / ${TOE.toFixed(3)}, vec3(${TOE_POWER.toFixed(3)}));
    vec3 shoulder = 1.0 - ${(1 - SHOULDER).toFixed(4)} * exp((${SHOULDER.toFixed(4)} - light) * ${ROLL_OFF.toFixed(4)});
    light = mix(mix(toe, light, step(${TOE.toFixed(3)}, light)), shoulder, step(${SHOULDER.toFixed(4)}, light));
    gl_FragColor.rgb = pow(light, vec3(1.0 / ${GAMMA.toFixed(2)}));
  }
`;

/**
 * Makes a material's light look as on film: brightly lit surfaces keep their shape, shadows are deep, and tones between
 * stay as they are. Only surfaces are affected, so that marks, lines, grids and backgrounds keep their exact colors.
 */
export function applyFilmicTone<T extends Material>(material: T): T {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace("#include <tonemapping_fragment>", TONE_SHADER);
  };
  material.customProgramCacheKey = () => "filmic";
  return material;
}
