/** The look of a frame that was not updated for a while. */
export interface Fade {
  /** 0 its own colours, 1 all grey. */
  grey: number;
  /** 1 opaque, 0 gone. */
  alpha: number;
}

const FRESH: Fade = { grey: 0, alpha: 1 };

/** RViz's ageing: a third of the timeout unchanged, a third turning grey, a third fading away. Seconds. */
export function fadeForAge(age: number, timeout: number): Fade {
  const third = timeout / 3;
  if (!(age > third)) return FRESH;
  if (age <= 2 * third) return { grey: (age - third) / third, alpha: 1 };
  return { grey: 1, alpha: Math.max(0, (timeout - age) / third) };
}
