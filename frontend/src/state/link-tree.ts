import type { JointDetails, LinkDetails } from "../protocol";
import type { DescriptionModel } from "./description-model";
import type { PageMemory } from "./page-memory";

/** A link in the tree, with its parent joint. */
export interface TreeRow {
  readonly link: LinkDetails;
  readonly joint: JointDetails | null;
  readonly depth: number;
  /** Whether the link has children. */
  readonly hasChildren: boolean;
  readonly folded: boolean;
}

/** The folded links, by name, so that a reload leaves the tree unchanged. */
export class LinkTreeState {
  private folded = new Set<string>();

  /** Preserves the folds across reloads of the page. */
  preserveIn(memory: PageMemory): void {
    memory.preserve("folded links", () => [...this.folded], (links) => (this.folded = new Set(links)));
  }

  isFolded(link: string): boolean {
    return this.folded.has(link);
  }

  toggle(link: string): void {
    if (!this.folded.delete(link)) this.folded.add(link);
  }

  /** Folds or unfolds everything. */
  foldAll(model: DescriptionModel, all: boolean): void {
    this.folded = new Set(all ? model.links.keys() : []);
  }

  /** Unfolds the ancestors of a link. */
  reveal(model: DescriptionModel, link: string): void {
    for (let joint = model.jointAbove(link); joint; joint = model.jointAbove(joint.parent)) this.folded.delete(joint.parent);
  }
}

/**
 * Returns the rows of a tree from its root down. During a search, folds are ignored, and only links remain whose name,
 * or whose joint's name, contains all words of the search, with their ancestors.
 */
export function visibleRows(model: DescriptionModel, state: LinkTreeState, search: string): TreeRow[] {
  const words = search.toLowerCase().split(/\s+/).filter((word) => word !== "");
  const matching = words.length > 0 ? matchesOf(model, words) : null;
  const rows: TreeRow[] = [];
  const seen = new Set<string>();
  const pending: [string, JointDetails | null, number][] = [[model.description.root, null, 0]];
  for (let next = pending.pop(); next; next = pending.pop()) {
    const [name, joint, depth] = next;
    const link = model.links.get(name);
    if (!link || seen.has(name) || (matching && !matching.has(name))) continue;
    seen.add(name);
    const below = model.jointsBelow(name);
    const folded = !matching && state.isFolded(name);
    rows.push({ link, joint, depth, hasChildren: below.length > 0, folded });
    if (folded) continue;
    for (const each of [...below].reverse()) pending.push([each.child, each, depth + 1]);
  }
  return rows;
}

function matchesOf(model: DescriptionModel, words: readonly string[]): Set<string> {
  const matching = new Set<string>();
  for (const link of model.links.keys()) {
    const names = `${link} ${model.jointAbove(link)?.name ?? ""}`.toLowerCase();
    if (!words.every((word) => names.includes(word))) continue;
    for (let at: string | undefined = link; at !== undefined && !matching.has(at); at = model.jointAbove(at)?.parent) matching.add(at);
  }
  return matching;
}
