import type { NamedFile } from "../connection/upload";

/** A dropped recording: the name of its file or folder, and its files. */
export interface Dropped {
  name: string;
  files: NamedFile[];
}

const RECORDING_FILE = /(^metadata\.yaml|\.(mcap|db3)(\.zstd)?)$/;

/** Returns the files of a recording among several, with the name of the file if there is only one. */
export function recordingAmong(name: string, files: readonly NamedFile[]): Dropped {
  const found = files.filter((file) => RECORDING_FILE.test(file.name));
  const messages = found.filter((each) => each.name !== "metadata.yaml");
  // The metadata of a single file add nothing to it.
  if (messages.length === 1 && messages[0]) return { name: messages[0].name, files: messages };
  return { name, files: messages.length > 0 ? found : [] };
}

/** Returns the dropped files, including those directly in a folder. */
export async function filesOf(transfer: DataTransfer): Promise<Dropped> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  const files: NamedFile[] = [];
  for (const entry of entries) {
    const candidates = entry.isFile ? [entry] : await entriesIn(entry as FileSystemDirectoryEntry);
    for (const file of candidates.filter(({ isFile }) => isFile)) files.push(await fileOf(file as FileSystemFileEntry));
  }
  return recordingAmong(entries[0]?.name ?? "", files);
}

function fileOf(entry: FileSystemFileEntry): Promise<NamedFile> {
  return new Promise((resolve, reject) => entry.file((file) => resolve({ name: file.name, file }), reject));
}

/** Returns all entries of a folder, which browsers return in batches. */
async function entriesIn(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const found: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return found;
    found.push(...some);
  }
}
