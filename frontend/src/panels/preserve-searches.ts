import type { PageMemory } from "../state/page-memory";
import type { Panel } from "./panel";

/** Preserves the search texts of panels across reloads of the page. */
export function preserveSearches(panels: readonly Panel[], memory: PageMemory): void {
  for (const { id, element } of panels) {
    const fields = [...element.querySelectorAll<HTMLInputElement>("input[type=search]")];
    if (fields.length === 0) continue;
    memory.preserve(`searches ${id}`, () => fields.map(({ value }) => value), (texts) => {
      for (const [i, field] of fields.entries()) {
        field.value = texts[i] ?? "";
        field.dispatchEvent(new Event("input"));
      }
    });
  }
}
