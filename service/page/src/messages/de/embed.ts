// Die Seite im Rahmen einer anderen, bevor diese sagt, wer gemessen wird.
import type { Messages } from "../catalogue";

export const embed: Messages["embed"] = {
  waiting: "Einen Augenblick …",
  alone: "Diese Seite ist dafür gemacht, von anderen Seiten gezeigt zu werden. Um jemanden zu vermessen, öffnen Sie die eigene Seite des Dienstes.",
};
