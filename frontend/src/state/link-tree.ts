import type { JointDetails, LinkDetails } from "../protocol";
import type { DescriptionModel } from "./description-model";
import type { Kept } from "./kept";

/** A link in the tree, with its parent joint. */
export interface TreeRow {
  readonly link: LinkDetails;
  readonly joint: JointDetails | null;
  readonly depth: number;
  /** Whether the link has children. */
  readonly inner: boolean;
  readonly folded: boolean;
}

/** The folded links, by name, so that a reload leaves the tree unchanged. */
export class LinkTreeState {
  private folded = new Set<string>();

  /** Preserves the folds across reloads of the page. */
  keep(kept: Kept): void {
    kept.part("folded links", () => [...this.folded], (links) => (this.folded = new Set(links)));
  }

  isFolded(link: string): boolean {
    return this.folded.has(link);
  }

  toggle(link: string): void {
    if (!this.folded.delete(link)) this.folded.add(link);
  }

  /** Folds or unfolds everything. */
  fold(model: DescriptionModel, all: boolean): void {
    this.folded = new Set(all ? model.links.keys() : []);
  }

  /** Unfolds the ancestors of a link. */
  open(model: DescriptionModel, link: string): void {
    for (let joint = model.jointAbove(link); joint; joint = model.jointAbove(joint.parent)) this.folded.delete(joint.parent);
  }
}

/**
 * Returns the rows of a tree from its root down. During a search, folds are ignored, and only links remain whose name,
 * or whose joint's name, contains all words of the search, with their ancestors.
 */
export function flattened(model: DescriptionModel, state: LinkTreeState, search: string): TreeRow[] {
  const words = search.toLowerCase().split(/\s+/).filter((word) => word !== "");
  const kept = words.length > 0 ? found(model, words) : null;
  const rows: TreeRow[] = [];
  const seen = new Set<string>();
  const pending: [string, JointDetails | null, number][] = [[model.description.root, null, 0]];
  for (let next = pending.pop(); next; next = pending.pop()) {
    const [name, joint, depth] = next;
    const link = model.links.get(name);
    if (!link || seen.has(name) || (kept && !kept.has(name))) continue;
    seen.add(name);
    const below = model.jointsBelow(name);
    const folded = !kept && state.isFolded(name);
    rows.push({ link, joint, depth, inner: below.length > 0, folded });
    if (folded) continue;
    for (const each of [...below].reverse()) pending.push([each.child, each, depth + 1]);
  }
  return rows;
}

function found(model: DescriptionModel, words: readonly string[]): Set<string> {
  const kept = new Set<string>();
  for (const link of model.links.keys()) {
    const names = `${link} ${model.jointAbove(link)?.name ?? ""}`.toLowerCase();
    if (!words.every((word) => names.includes(word))) continue;
    for (let at: string | undefined = link; at !== undefined && !kept.has(at); at = model.jointAbove(at)?.parent) kept.add(at);
  }
  return kept;
}
