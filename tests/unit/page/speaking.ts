// The tests hear English, unless they ask for another language.
import { en } from "../../../service/page/src/messages/en";
import { speak } from "../../../service/page/src/messages/language";

speak({ language: "en", locale: "en", messages: en });
