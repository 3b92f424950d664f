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
  readonly isFolded: boolean;
}

/** The folded links, by name, so that a reload leaves the tree unchanged. */
export class LinkTreeState {
  private foldedLinks = new Set<string>();

  /** Preserves the folds across reloads of the page. */
  preserveIn(memory: PageMemory): void {
    memory.preserve("folded links", () => [...this.foldedLinks], (links) => (this.foldedLinks = new Set(links)));
  }

  isFolded(link: string): boolean {
    return this.foldedLinks.has(link);
  }

  toggle(link: string): void {
    if (!this.foldedLinks.delete(link)) this.foldedLinks.add(link);
  }

  /** Folds or unfolds everything. */
  setAllFolded(model: DescriptionModel, isFolded: boolean): void {
    this.foldedLinks = new Set(isFolded ? model.links.keys() : []);
  }

  /** Unfolds the ancestors of a link. */
  reveal(model: DescriptionModel, link: string): void {
    for (let joint = model.parentJointOf(link); joint; joint = model.parentJointOf(joint.parent)) this.foldedLinks.delete(joint.parent);
  }
}

/**
 * Returns the rows of a tree from its root down. During a search, folds are ignored, and only links remain whose name,
 * or whose joint's name, contains all words of the search, with their ancestors.
 */
export function listVisibleRows(model: DescriptionModel, state: LinkTreeState, search: string): TreeRow[] {
  const searchWords = search.toLowerCase().split(/\s+/).filter((word) => word !== "");
  const matchingLinks = searchWords.length > 0 ? findMatchingLinks(model, searchWords) : null;
  const rows: TreeRow[] = [];
  const visited = new Set<string>();
  const stack: [string, JointDetails | null, number][] = [[model.description.root, null, 0]];
  for (let next = stack.pop(); next; next = stack.pop()) {
    const [name, joint, depth] = next;
    const link = model.links.get(name);
    if (!link || visited.has(name) || (matchingLinks && !matchingLinks.has(name))) continue;
    visited.add(name);
    const joints = model.childJointsOf(name);
    const isFolded = !matchingLinks && state.isFolded(name);
    rows.push({ link, joint, depth, hasChildren: joints.length > 0, isFolded });
    if (isFolded) continue;
    for (const joint of [...joints].reverse()) stack.push([joint.child, joint, depth + 1]);
  }
  return rows;
}

function findMatchingLinks(model: DescriptionModel, searchWords: readonly string[]): Set<string> {
  const matchingLinks = new Set<string>();
  for (const link of model.links.keys()) {
    const names = `${link} ${model.parentJointOf(link)?.name ?? ""}`.toLowerCase();
    if (!searchWords.every((word) => names.includes(word))) continue;
    let ancestor: string | undefined = link;
    while (ancestor !== undefined && !matchingLinks.has(ancestor)) {
      matchingLinks.add(ancestor);
      ancestor = model.parentJointOf(ancestor)?.parent;
    }
  }
  return matchingLinks;
}
