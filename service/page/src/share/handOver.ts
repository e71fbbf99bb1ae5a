// Give a file to others: by the device's own sheet where it takes files, else as a download.
import { saveFile } from "../ui/save";

/** False where the tap that asked for it was too long ago for the sheet: it takes another one. */
export async function handOver(file: File): Promise<boolean> {
  if (!navigator.canShare?.({ files: [file] })) {
    saveFile(file.name, file);
    return true;
  }
  try {
    await navigator.share({ files: [file] });
  } catch (error) {
    const { name } = error as DOMException;
    if (name === "NotAllowedError") return false;
    // Whoever closed the sheet does not want it.
    if (name !== "AbortError") saveFile(file.name, file);
  }
  return true;
}
