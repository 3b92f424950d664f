/**
 * Returns the non-decreasing values closest to the given ones (least squares): neighbors in the wrong order are
 * averaged.
 */
export function fitIsotonic(values: readonly number[]): number[] {
  const blocks: { sum: number; count: number }[] = [];
  for (const value of values) {
    let block = { sum: value, count: 1 };
    for (let previous = blocks.at(-1); previous && previous.sum / previous.count > block.sum / block.count; previous = blocks.at(-1)) {
      block = { sum: previous.sum + block.sum, count: previous.count + block.count };
      blocks.pop();
    }
    blocks.push(block);
  }
  return blocks.flatMap(({ sum, count }) => new Array<number>(count).fill(sum / count));
}
