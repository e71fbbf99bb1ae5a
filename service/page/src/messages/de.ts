// German; it addresses people by "Sie".
import type { Messages } from "./catalogue";
import { accuracy } from "./de/accuracy";
import { answers } from "./de/answers";
import { derived } from "./de/derived";
import { embed } from "./de/embed";
import { files } from "./de/files";
import { fit } from "./de/fit";
import { frame } from "./de/frame";
import { howto } from "./de/howto";
import { limbs } from "./de/limbs";
import { look } from "./de/look";
import { measure } from "./de/measure";
import { mask } from "./de/mask";
import { measures } from "./de/measures";
import { panel } from "./de/panel";
import { people } from "./de/people";
import { person } from "./de/person";
import { points } from "./de/points";
import { result } from "./de/result";
import { stage } from "./de/stage";
import { start } from "./de/start";

export const de: Messages = { accuracy, answers, derived, embed, files, fit, frame, howto, limbs, look, mask, measure, measures, panel, people, person, points, result, stage, start };
