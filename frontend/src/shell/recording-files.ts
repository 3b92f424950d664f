import type { NamedFile } from "../connection/upload";

/** A dropped recording: the name of its file or folder, and its files. */
export interface DroppedRecording {
  name: string;
  files: NamedFile[];
}

const RECORDING_FILE = /(^metadata\.yaml|\.(mcap|db3)(\.zstd)?)$/;

/** Returns the files that belong to a recording; a recording of a single file has the name of this file. */
export function findRecording(name: string, files: readonly NamedFile[]): DroppedRecording {
  const recordingFiles = files.filter((file) => RECORDING_FILE.test(file.name));
  const messageFiles = recordingFiles.filter((file) => file.name !== "metadata.yaml");
  // A single file does not need its metadata.
  if (messageFiles.length === 1 && messageFiles[0]) return { name: messageFiles[0].name, files: messageFiles };
  return { name, files: messageFiles.length > 0 ? recordingFiles : [] };
}

/** Returns the dropped files, including those directly in a folder. */
export async function readDroppedFiles(transfer: DataTransfer): Promise<DroppedRecording> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  const files: NamedFile[] = [];
  for (const entry of entries) {
    const candidates = entry.isFile ? [entry] : await readEntries(entry as FileSystemDirectoryEntry);
    for (const file of candidates.filter(({ isFile }) => isFile)) files.push(await readFile(file as FileSystemFileEntry));
  }
  return findRecording(entries[0]?.name ?? "", files);
}

function readFile(entry: FileSystemFileEntry): Promise<NamedFile> {
  return new Promise((resolve, reject) => entry.file((file) => resolve({ name: file.name, file }), reject));
}

/** Returns all entries of a folder, which browsers return in batches. */
async function readEntries(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const entries: FileSystemEntry[] = [];
  for (;;) {
    const batch = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (batch.length === 0) return entries;
    entries.push(...batch);
  }
}
