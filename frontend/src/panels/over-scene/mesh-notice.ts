import { coalesce, h } from "../../dom";
import { formatBytes } from "../../scene/meshes/mesh-error";
import type { MeshLoad, MeshProgress } from "../../state/mesh-progress";
import { strings } from "../../strings";

/** The maximum number of files listed; the others are counted. */
const MAX_LISTED_FILES = 4;

/** The notice over the scene while mesh files take noticeably long to load: the files and their progress. */
export class MeshNotice {
  readonly element = h("div", { class: "line-notice", role: "status", data: { notice: "meshes" } });

  constructor(private readonly progress: MeshProgress) {
    progress.changed.on(coalesce(() => this.update()));
    this.update();
  }

  private update(): void {
    const texts = strings.meshes.progress;
    const { loads } = this.progress;
    this.element.hidden = loads.length === 0;
    const lines = loads.slice(0, MAX_LISTED_FILES).map((load) => h("div", {}, h("b", {}, load.name), ` ${formatProgress(load)}`));
    const furtherFiles = loads.length > MAX_LISTED_FILES ? h("div", {}, texts.more(String(loads.length - MAX_LISTED_FILES))) : "";
    this.element.replaceChildren(h("strong", {}, texts.title), ...lines, furtherFiles);
  }
}

/** Returns the progress of a file: bytes of the total, or that it is being read. */
export function formatProgress({ bytes, total, stage }: Readonly<MeshLoad>): string {
  const texts = strings.meshes.progress;
  if (stage === "reading") return texts.reading;
  return total === null ? formatBytes(bytes) : texts.of(formatBytes(bytes), formatBytes(total));
}
