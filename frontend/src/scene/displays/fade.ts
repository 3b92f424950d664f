/** How a frame that was not updated for a while is drawn. */
export interface Fade {
  /** 0: its own colors, 1: gray. */
  gray: number;
  /** 1: opaque, 0: invisible. */
  alpha: number;
}

const UNFADED: Fade = { gray: 0, alpha: 1 };

/**
 * Returns RViz's fading for an age, s: unchanged for a third of the timeout, turning gray for a third, fading out for a
 * third.
 */
export function fadeForAge(age: number, timeout: number): Fade {
  const third = timeout / 3;
  if (!(age > third)) return UNFADED;
  if (age <= 2 * third) return { gray: (age - third) / third, alpha: 1 };
  return { gray: 1, alpha: Math.max(0, (timeout - age) / third) };
}
