#pragma once

#include "measurement/report/speech.h"

#include <optional>

/// Every text of the report, in English, German, French, Spanish and Simplified Chinese.
/// %1 ... stand for what is filled in. A missing translation does not compile.
namespace tarsus::phrase {

/// A word of the record's fields or of the scores; null where it is not known.
[[nodiscard]] const Phrase* termNamed(std::string_view word);

struct KnownSentence {
  const Phrase* phrase = nullptr;
  QStringList values;  ///< for %1, %2 ...
};

/// A sentence that measurement, comparison, reconstruction or scores wrote in English, with what
/// is filled in; nothing where it is not known.
[[nodiscard]] std::optional<KnownSentence> sentenceNamed(const QString& english);

// clang-format off
// Page
inline constexpr Phrase kTarsus{"Tarsus", "Tarsus", "Tarsus", "Tarsus", "Tarsus"};
inline constexpr Phrase kWoundReport{"Wound report", "Wundbericht", "Rapport de plaie", "Informe de herida", "创面报告"};
inline constexpr Phrase kDraft{"DRAFT · not signed", "ENTWURF · nicht signiert", "BROUILLON · non signé", "BORRADOR · sin firmar", "草稿 · 未签名"};
inline constexpr Phrase kSigned{"SIGNED", "SIGNIERT", "SIGNÉ", "FIRMADO", "已签名"};
inline constexpr Phrase kReviewed{"SIGNED, COUNTERSIGNED", "SIGNIERT, GEGENGEZEICHNET", "SIGNÉ, CONTRESIGNÉ", "FIRMADO, REFRENDADO", "已签名并复签"};
inline constexpr Phrase kUnfitBadge{"NOT FIT FOR MEASUREMENT", "ZUM MESSEN UNGEEIGNET", "IMPROPRE À LA MESURE", "NO APTO PARA MEDIR", "不适合测量"};
inline constexpr Phrase kInvented{"SAMPLE · invented data · no real person", "MUSTER · erfundene Daten · keine reale Person", "EXEMPLE · données inventées · aucune personne réelle", "MUESTRA · datos inventados · ninguna persona real", "样例 · 虚构数据 · 非真实人物"};
inline constexpr Phrase kResearchUse{
  "Research software. Not a medical device; not cleared by any authority; must not be the sole basis of a clinical decision. Accuracy shown is from the listed phantoms.",
  "Forschungssoftware. Kein Medizinprodukt; von keiner Behörde zugelassen; darf nicht alleinige Grundlage einer klinischen Entscheidung sein. Die angegebene Genauigkeit stammt von den aufgeführten Phantomen.",
  "Logiciel de recherche. N’est pas un dispositif médical ; autorisé par aucune autorité ; ne doit pas être la seule base d’une décision clinique. L’exactitude indiquée provient des fantômes cités.",
  "Software de investigación. No es un producto sanitario; no autorizado por ninguna autoridad; no debe ser la única base de una decisión clínica. La exactitud indicada procede de los fantomas citados.",
  "科研软件。非医疗器械；未获任何机构批准；不得作为临床决策的唯一依据。所示准确度来自所列体模。"};
inline constexpr Phrase kPage{"page %1/%2", "Seite %1/%2", "page %1/%2", "página %1/%2", "第 %1 页，共 %2 页"};
inline constexpr Phrase kModelHash{"model SHA-256 %1", "Modell SHA-256 %1", "modèle SHA-256 %1", "modelo SHA-256 %1", "模型 SHA-256 %1"};
inline constexpr Phrase kRecordHash{"record SHA-256 %1", "Datensatz SHA-256 %1", "dossier SHA-256 %1", "registro SHA-256 %1", "记录 SHA-256 %1"};
inline constexpr Phrase kProgram{"Tarsus %1", "Tarsus %1", "Tarsus %1", "Tarsus %1", "Tarsus %1"};
inline constexpr Phrase kCreated{"created %1", "erzeugt %1", "créé le %1", "creado el %1", "生成于 %1"};
inline constexpr Phrase kNoRecordHash{"no record hash before signing", "kein Datensatz-Hash vor der Signatur", "pas d’empreinte du dossier avant signature", "sin huella del registro antes de la firma", "签名前无记录哈希"};
inline constexpr Phrase kNotRecorded{"not recorded", "nicht erfasst", "non renseigné", "no registrado", "未记录"};
inline constexpr Phrase kAnd{"%1 and %2", "%1 und %2", "%1 et %2", "%1 y %2", "%1和%2"};
inline constexpr Phrase kVersion{"version %1", "Version %1", "version %1", "versión %1", "第 %1 版"};
inline constexpr Phrase kOneAmendment{"(1 amendment)", "(1 Nachtrag)", "(1 amendement)", "(1 enmienda)", "（1 次修订）"};
inline constexpr Phrase kAmendments{"(%1 amendments)", "(%1 Nachträge)", "(%1 amendements)", "(%1 enmiendas)", "（%1 次修订）"};

// 1 Identity, key values, sentence
inline constexpr Phrase kIdentity{"Identity and key values", "Angaben und Hauptwerte", "Identité et valeurs principales", "Identidad y valores principales", "身份与主要数值"};
inline constexpr Phrase kWound{"Wound", "Wunde", "Plaie", "Herida", "创面"};
inline constexpr Phrase kReportMade{"Report made", "Bericht erstellt", "Rapport établi", "Informe creado", "报告生成"};
inline constexpr Phrase kPatient{"Patient", "Patient/in", "Patient(e)", "Paciente", "患者"};
inline constexpr Phrase kVisit{"Visit", "Visite", "Visite", "Visita", "就诊"};
inline constexpr Phrase kBorn{"born %1", "geb. %1", "né(e) le %1", "nac. %1", "出生 %1"};
inline constexpr Phrase kAge{"%1 y", "%1 J.", "%1 ans", "%1 años", "%1 岁"};
inline constexpr Phrase kId{"ID %1", "Nr. %1", "n° %1", "n.º %1", "编号 %1"};
inline constexpr Phrase kVisitOf{"%1 of %2", "%1 von %2", "%1 sur %2", "%1 de %2", "第 %1/%2 次"};
inline constexpr Phrase kDay{"day %1", "Tag %1", "jour %1", "día %1", "第 %1 天"};
inline constexpr Phrase kScanned{"scanned %1 by %2", "aufgenommen %1 · %2", "numérisé à %1 par %2", "escaneado %1 por %2", "扫描于 %1 · %2"};
inline constexpr Phrase kReportId{"Report %1", "Bericht %1", "Rapport %1", "Informe %1", "报告 %1"};
inline constexpr Phrase kWoundName{"W%1", "W%1", "P%1", "H%1", "W%1"};
inline constexpr Phrase kLeftFoot{"left foot", "linker Fuß", "pied gauche", "pie izquierdo", "左足"};
inline constexpr Phrase kRightFoot{"right foot", "rechter Fuß", "pied droit", "pie derecho", "右足"};
inline constexpr Phrase kSideNotRecorded{"side not recorded", "Seite nicht erfasst", "côté non renseigné", "lado no registrado", "侧别未记录"};
inline constexpr Phrase kOnset{"onset %1", "Beginn %1", "début %1", "inicio %1", "起病 %1"};
inline constexpr Phrase kNotMeasurable{"not measurable", "nicht messbar", "non mesurable", "no medible", "无法测量"};
inline constexpr Phrase kNoReason{"no reason was recorded", "kein Grund erfasst", "aucune raison enregistrée", "sin motivo registrado", "未记录原因"};
inline constexpr Phrase kIntervalOf{"95 % interval %1", "95-%-Intervall %1", "intervalle à 95 % %1", "intervalo 95 % %1", "95% 区间 %1"};
inline constexpr Phrase kNoInterval{"no interval", "kein Intervall", "pas d’intervalle", "sin intervalo", "无区间"};
inline constexpr Phrase kSinceVisit{"%1 since visit %2", "%1 seit Visite %2", "%1 depuis la visite %2", "%1 desde la visita %2", "%1 较第 %2 次"};
inline constexpr Phrase kNoDetectable{"no detectable change", "nicht nachweisbar verändert", "pas de changement détectable", "sin cambio detectable", "无可检出变化"};
inline constexpr Phrase kNotComparable{"not comparable with visit %1", "mit Visite %1 nicht vergleichbar", "non comparable à la visite %1", "no comparable con la visita %1", "无法与第 %1 次比较"};
inline constexpr Phrase kOfBaseline{"%1 of baseline", "%1 des Ausgangswerts", "%1 de la valeur initiale", "%1 del valor inicial", "占基线 %1"};
inline constexpr Phrase kAreaReductionSince{"Area reduction since visit %1", "Flächenabnahme seit Visite %1", "Réduction depuis la visite %1", "Reducción desde la visita %1", "较第 %1 次面积缩小"};
inline constexpr Phrase kInDays{"in %1 days", "in %1 Tagen", "en %1 jours", "en %1 días", "%1 天内"};
inline constexpr Phrase kGroupMark{"published group mark at 4 weeks: 50–53 %, see 7", "publizierter Gruppenwert nach 4 Wochen: 50–53 %, siehe 7", "repère de groupe publié à 4 semaines : 50–53 %, voir 7", "valor de grupo publicado a 4 semanas: 50–53 %, véase 7", "已发表的 4 周群体界值：50–53%，见第 7 节"};
inline constexpr Phrase kBaselineIs{"baseline = visit %1, %2", "Ausgangswert: Visite %1, %2", "initiale = visite %1, %2", "inicial = visita %1, %2", "基线 = 第 %1 次，%2"};
inline constexpr Phrase kMeasuredOf{"Measured: %1 of %2 quantities.", "Gemessen: %1 von %2 Größen.", "Mesuré : %1 grandeurs sur %2.", "Medido: %1 de %2 magnitudes.", "%2 项量值中已测 %1 项。"};
inline constexpr Phrase kNotMeasurableList{"Not measurable: %1.", "Nicht messbar: %1.", "Non mesurable : %1.", "No medible: %1.", "无法测量：%1。"};
inline constexpr Phrase kShallow{"Volume ÷ area is %1; under 4 mm volume is less precise than about 5 %.", "Volumen ÷ Fläche ist %1; unter 4 mm ist das Volumen ungenauer als etwa 5 %.", "Volume ÷ surface : %1 ; sous 4 mm, le volume est moins précis qu’environ 5 %.", "Volumen ÷ área: %1; por debajo de 4 mm el volumen es menos preciso que un 5 %.", "容积 ÷ 面积为 %1；低于 4 mm 时容积精度低于约 5%。"};
inline constexpr Phrase kSinceSentence{"Since visit %1 (%2 days) %3.", "Seit Visite %1 (%2 Tage): %3.", "Depuis la visite %1 (%2 jours), %3.", "Desde la visita %1 (%2 días) %3.", "较第 %1 次就诊（%2 天）：%3。"};
inline constexpr Phrase kFirstVisit{"First visit: there is nothing to compare with.", "Erste Visite: kein Vergleich möglich.", "Première visite : aucune comparaison possible.", "Primera visita: no hay con qué comparar.", "首次就诊：无可比较的数据。"};
inline constexpr Phrase kSArea{"area", "Fläche", "la surface", "el área", "面积"};
inline constexpr Phrase kSVolume{"volume", "Volumen", "le volume", "el volumen", "容积"};
inline constexpr Phrase kSDepth{"greatest depth", "größte Tiefe", "la profondeur maximale", "la profundidad máxima", "最大深度"};
inline constexpr Phrase kFellOne{"%1 fell", "%1 hat abgenommen", "%1 a diminué", "%1 disminuyó", "%1减小"};
inline constexpr Phrase kFellMany{"%1 fell", "%1 haben abgenommen", "%1 ont diminué", "%1 disminuyeron", "%1减小"};
inline constexpr Phrase kRoseOne{"%1 rose", "%1 hat zugenommen", "%1 a augmenté", "%1 aumentó", "%1增大"};
inline constexpr Phrase kRoseMany{"%1 rose", "%1 haben zugenommen", "%1 ont augmenté", "%1 aumentaron", "%1增大"};
inline constexpr Phrase kSameOne{"%1 did not change detectably", "%1 hat sich nicht nachweisbar verändert", "%1 n’a pas changé de façon détectable", "%1 no cambió de forma detectable", "%1无可检出变化"};
inline constexpr Phrase kSameMany{"%1 did not change detectably", "%1 haben sich nicht nachweisbar verändert", "%1 n’ont pas changé de façon détectable", "%1 no cambiaron de forma detectable", "%1无可检出变化"};
inline constexpr Phrase kUnknownOne{"%1 could not be compared", "%1 war nicht vergleichbar", "%1 n’a pas pu être comparé(e)", "%1 no se pudo comparar", "%1无法比较"};
inline constexpr Phrase kUnknownMany{"%1 could not be compared", "%1 waren nicht vergleichbar", "%1 n’ont pas pu être comparés", "%1 no se pudieron comparar", "%1无法比较"};
inline constexpr Phrase kEachMore{"each by more than the smallest detectable change", "jeweils um mehr als die kleinste nachweisbare Änderung", "chaque fois de plus que le plus petit changement détectable", "cada vez en más que el menor cambio detectable", "变化均超过最小可检出变化"};
inline constexpr Phrase kByMore{"by more than the smallest detectable change", "um mehr als die kleinste nachweisbare Änderung", "de plus que le plus petit changement détectable", "en más que el menor cambio detectable", "变化超过最小可检出变化"};
inline constexpr Phrase kDeeperAt{"The bed is deeper than at visit %1 at %2 o’clock (see 8).", "Bei %2 Uhr liegt der Wundgrund tiefer als bei Visite %1 (siehe 8).", "Le fond est plus profond qu’à la visite %1 à %2 h (voir 8).", "El lecho es más profundo que en la visita %1 a las %2 (véase 8).", "%2 点方向的创基较第 %1 次更深（见第 8 节）。"};
inline constexpr Phrase kUnfitScan{"This scan is not fit for measurement", "Diese Aufnahme ist zum Messen ungeeignet", "Cette numérisation est impropre à la mesure", "Este escaneo no es apto para medir", "此次扫描不适合测量"};
inline constexpr Phrase kScanAgain{"Do not use the numbers; scan again.", "Die Zahlen nicht verwenden; erneut aufnehmen.", "Ne pas utiliser les valeurs ; numériser à nouveau.", "No utilice los números; escanee de nuevo.", "请勿使用这些数值；请重新扫描。"};

inline constexpr Phrase kNotSamePlace{
  "The numbers of both visits stand, but that both show the same place could not be confirmed (see 8).",
  "Die Zahlen beider Visiten gelten, doch dass beide dieselbe Stelle zeigen, ließ sich nicht bestätigen (siehe 8).",
  "Les valeurs des deux visites restent valables, mais il n’a pas pu être confirmé que les deux montrent le même endroit (voir 8).",
  "Los números de ambas visitas son válidos, pero no se pudo confirmar que ambas muestren el mismo lugar (véase 8).",
  "两次就诊的数值均有效，但无法确认两者显示的是同一部位（见第 8 节）。"};
inline constexpr Phrase kNoScanWords{"This visit has no usable scan; nothing was measured on a model.", "Diese Visite hat keine brauchbare Aufnahme; an keinem Modell wurde gemessen.", "Cette visite n’a pas de numérisation utilisable ; rien n’a été mesuré sur un modèle.", "Esta visita no tiene un escaneo utilizable; nada se midió en un modelo.", "本次就诊无可用扫描；未在模型上测量。"};
inline constexpr Phrase kNoScan{"No usable scan", "Keine brauchbare Aufnahme", "Pas de numérisation utilisable", "Sin escaneo utilizable", "无可用扫描"};
inline constexpr Phrase kEnteredAt{"entered for %1 by %2", "erfasst für %1 · %2", "saisi pour %1 par %2", "registrado para %1 por %2", "录入 %1 · %2"};
inline constexpr Phrase kDraftVisit{"(draft)", "(Entwurf)", "(brouillon)", "(borrador)", "（草稿）"};
inline constexpr Phrase kPhotograph{"Photograph: %1 · without scale, not for measuring", "Foto: %1 · ohne Maßstab, nicht zum Messen", "Photographie : %1 · sans échelle, pas pour mesurer", "Fotografía: %1 · sin escala, no sirve para medir", "照片：%1 · 无比例尺，不可用于测量"};
inline constexpr Phrase kMorePhotographs{"%1 more photographs in the record", "%1 weitere Fotos im Datensatz", "%1 autres photographies dans le dossier", "%1 fotografías más en el registro", "记录中另有 %1 张照片"};
inline constexpr Phrase kNoPhotograph{"No photograph was kept with this visit.", "Zu dieser Visite ist kein Foto abgelegt.", "Aucune photographie n’a été conservée avec cette visite.", "No se guardó ninguna fotografía con esta visita.", "本次就诊未保存照片。"};
inline constexpr Phrase kNoPictureFile{"Left out, as they are no JPEG or PNG pictures: %1.", "Weggelassen, da keine Bilder in JPEG oder PNG: %1.", "Omis, car ce ne sont pas des images JPEG ou PNG : %1.", "Omitidos por no ser imágenes JPEG o PNG: %1.", "以下文件不是 JPEG 或 PNG 图像，未印出：%1。"};
inline constexpr Phrase kRulerTyped{"Length × width, ruler", "Länge × Breite, Lineal", "Longueur × largeur, règle", "Longitud × anchura, regla", "长 × 宽（尺）"};
inline constexpr Phrase kProbeTyped{"Depth, probe", "Tiefe, Sonde", "Profondeur, stylet", "Profundidad, sonda", "深度（探针）"};
inline constexpr Phrase kByRuler{"typed, by ruler", "eingegeben, mit dem Lineal", "saisi, à la règle", "escrito, con regla", "手工录入，尺量"};
inline constexpr Phrase kTypedByProbe{"typed, by probe", "eingegeben, mit der Sonde", "saisi, au stylet", "escrito, con sonda", "手工录入，探针"};
inline constexpr Phrase kUnprinted{"□: letters that no font here holds: %1", "□: Zeichen, die keine Schrift hier enthält: %1", "□ : caractères absents des polices : %1", "□: letras que ninguna fuente contiene: %1", "□：字体中没有的字符：%1"};

// 2, 3 Pictures and section
inline constexpr Phrase kFootMap{"Foot map", "Fußkarte", "Carte du pied", "Mapa del pie", "足部图"};
inline constexpr Phrase kWholeModel{"Whole model, 1 : %1", "Ganzes Modell, 1 : %1", "Modèle entier, 1 : %1", "Modelo entero, 1 : %1", "整体模型，1 : %1"};
inline constexpr Phrase kImages{"Images of the wound", "Bilder der Wunde", "Images de la plaie", "Imágenes de la herida", "创面图像"};
inline constexpr Phrase kTexture{"Texture with wound outline", "Textur mit Wundumriss", "Texture et contour de la plaie", "Textura con contorno", "纹理与创面轮廓"};
inline constexpr Phrase kShaded{"Shaded skin with wound outline, no colour", "Schattierte Haut mit Umriss, ohne Farbe", "Peau ombrée et contour, sans couleur", "Piel sombreada y contorno, sin color", "阴影皮肤与轮廓，无颜色"};
inline constexpr Phrase kDepthBelow{"Depth below reference skin", "Tiefe unter der Referenzhaut", "Profondeur sous la peau de référence", "Profundidad bajo la piel de referencia", "低于参考皮面的深度"};
inline constexpr Phrase kShadedNoDepth{"Shaded skin; depth not measurable", "Schattierte Haut; Tiefe nicht messbar", "Peau ombrée ; profondeur non mesurable", "Piel sombreada; profundidad no medible", "阴影皮肤；深度无法测量"};
inline constexpr Phrase kNoPicture{"no picture", "kein Bild", "pas d’image", "sin imagen", "无图像"};
inline constexpr Phrase kToes{"toes", "Zehen", "orteils", "dedos", "足趾"};
inline constexpr Phrase kHeel{"heel", "Ferse", "talon", "talón", "足跟"};
inline constexpr Phrase kMedial{"medial", "medial", "médial", "medial", "内侧"};
inline constexpr Phrase kLateral{"lateral", "lateral", "latéral", "lateral", "外侧"};
inline constexpr Phrase kWoundOutline{"wound outline", "Wundumriss", "contour", "contorno", "创面轮廓"};
inline constexpr Phrase kSkinCurve{"skin curve", "Hautkurve", "courbe cutanée", "curva de piel", "皮肤曲线"};
inline constexpr Phrase kDeepest{"deepest point", "tiefste Stelle", "point le plus profond", "punto más profundo", "最深点"};
inline constexpr Phrase kUnseen{"bed not seen (%1)", "Wundgrund nicht gesehen (%1)", "fond non vu (%1)", "lecho no visto (%1)", "未见到的创基（%1）"};
inline constexpr Phrase kPicturesAt{"Pictures %1 : 1", "Bilder %1 : 1", "Images %1 : 1", "Imágenes %1 : 1", "图像 %1 : 1"};
inline constexpr Phrase kClockIs{"; clock: heel 12, toes 6, drawn toes up.", "; Uhr: Ferse 12, Zehen 6, Zehen oben.", " ; cadran : talon 12, orteils 6, orteils en haut.", "; reloj: talón 12, dedos 6, dedos arriba.", "；钟面：足跟 12，足趾 6，足趾朝上。"};
inline constexpr Phrase kNoClock{"; no clock: heel and toes were not marked on the model.", "; keine Uhr: Ferse und Zehen sind am Modell nicht markiert.", " ; pas de cadran : talon et orteils non marqués sur le modèle.", "; sin reloj: talón y dedos no marcados en el modelo.", "；无钟面：模型上未标记足跟与足趾。"};
inline constexpr Phrase kContoursEvery{"Contours every %1 mm.", "Höhenlinien je %1 mm.", "Isolignes tous les %1 mm.", "Isolíneas cada %1 mm.", "等深线间隔 %1 mm。"};
inline constexpr Phrase kSection{"Section A–A′ through the deepest point", "Schnitt A–A′ durch die tiefste Stelle", "Coupe A–A′ par le point le plus profond", "Corte A–A′ por el punto más profundo", "经最深点的剖面 A–A′"};
inline constexpr Phrase kSectionNote{"%1 : 1 in both directions; not exaggerated. Levelled on the skin curve K–K′. Solid: wound bed and skin. Dashed: reference skin.", "%1 : 1 in beiden Richtungen; nicht überhöht. Ausgerichtet an der Hautkurve K–K′. Durchgezogen: Wundgrund und Haut. Gestrichelt: Referenzhaut.", "%1 : 1 dans les deux sens ; sans exagération. Nivelée sur la courbe cutanée K–K′. Trait plein : fond et peau. Tirets : peau de référence.", "%1 : 1 en ambas direcciones; sin exagerar. Nivelado en la curva de piel K–K′. Continua: lecho y piel. Discontinua: piel de referencia.", "两方向均为 %1 : 1，未夸大。以皮肤曲线 K–K′ 找平。实线：创基与皮肤；虚线：参考皮面。"};
inline constexpr Phrase kSectionFirst{"Dotted: bed at visit %1.", "Punktiert: Grund bei Visite %1.", "Pointillé : fond à la visite %1.", "Punteada: lecho en la visita %1.", "点线：第 %1 次创基。"};
inline constexpr Phrase kUnseenLarger{"Part of the bed was not seen; there the true value may be larger.", "Ein Teil des Wundgrunds wurde nicht gesehen; dort kann der wahre Wert größer sein.", "Une partie du fond n’a pas été vue ; la valeur vraie peut y être plus grande.", "Parte del lecho no se vio; allí el valor real puede ser mayor.", "部分创基未见到；该处真实值可能更大。"};

// The other wounds of the visit
inline constexpr Phrase kOtherWound{"Other wound", "Weitere Wunde", "Autre plaie", "Otra herida", "其他创面"};
inline constexpr Phrase kOtherReport{"Pictures %1 : 1. In full in its own report, %2.", "Bilder %1 : 1. Vollständig im eigenen Bericht %2.", "Images %1 : 1. Détails dans son propre rapport, %2.", "Imágenes %1 : 1. Completo en su propio informe, %2.", "图像 %1 : 1。详见其单独报告 %2。"};
inline constexpr Phrase kMoreWounds{"and %1 more", "und %1 weitere", "et %1 de plus", "y %1 más", "另有 %1 处"};

// The bedside form
inline constexpr Phrase kBedsideForm{"Bedside form", "Formular am Krankenbett", "Fiche au lit du patient", "Ficha de cabecera", "床旁表单"};
inline constexpr Phrase kNinetyFive{"95 %: %1", "95 %: %1", "95 % : %1", "95 %: %1", "95%：%1"};
inline constexpr Phrase kSinceVisitFrom{"%1 since visit %2 (%3)", "%1 seit Visite %2 (%3)", "%1 depuis la visite %2 (%3)", "%1 desde la visita %2 (%3)", "%1 较第 %2 次（%3）"};
inline constexpr Phrase kTissueExudate{"tissue, exudate", "Gewebe, Exsudat", "tissus, exsudat", "tejido, exudado", "组织、渗液"};
inline constexpr Phrase kInfectionSigns{"infection signs", "Infektionszeichen", "signes d’infection", "signos de infección", "感染体征"};
inline constexpr Phrase kStillMissing{"still missing", "fehlt noch", "manque encore", "falta aún", "尚缺"};
inline constexpr Phrase kNextVisit{"next visit", "nächste Visite", "prochaine visite", "próxima visita", "下次就诊"};
inline constexpr Phrase kWithScan{"with scan", "mit Aufnahme", "avec numérisation", "con escaneo", "含扫描"};
inline constexpr Phrase kByHand{"notes by hand", "Notizen von Hand", "notes à la main", "notas a mano", "手写备注"};
inline constexpr Phrase kNameTimeSign{"name, time, signature", "Name, Zeit, Unterschrift", "nom, heure, signature", "nombre, hora, firma", "姓名、时间、签名"};
inline constexpr Phrase kFoam{"foam", "Schaum", "mousse", "espuma", "泡沫"};
inline constexpr Phrase kAlginate{"alginate", "Alginat", "alginate", "alginato", "藻酸盐"};
inline constexpr Phrase kHydrofibre{"hydrofibre", "Hydrofaser", "hydrofibre", "hidrofibra", "亲水纤维"};
inline constexpr Phrase kOtherBox{"other: ____________", "anderes: ____________", "autre : ____________", "otro: ____________", "其他：____________"};
inline constexpr Phrase kCast{"cast", "Gips", "plâtre", "yeso", "石膏"};
inline constexpr Phrase kWalker{"walker", "Orthese", "botte", "bota", "步行靴"};
inline constexpr Phrase kFelt{"felt", "Filz", "feutre", "fieltro", "毛毡"};
inline constexpr Phrase kShoe{"shoe", "Schuh", "chaussure", "zapato", "鞋"};

// 4 Measurements
inline constexpr Phrase kMeasurements{"Measurements", "Messwerte", "Mesures", "Mediciones", "测量值"};
inline constexpr Phrase kContinued{"Measurements, continued", "Messwerte, Fortsetzung", "Mesures, suite", "Mediciones, continuación", "测量值（续）"};
inline constexpr Phrase kPreviousBaseline{"previous = visit %1, %2 · baseline = visit %3, %4", "vorher = Visite %1, %2 · Ausgang = Visite %3, %4", "précédente = visite %1, %2 · initiale = visite %3, %4", "previa = visita %1, %2 · inicial = visita %3, %4", "上次 = 第 %1 次，%2 · 基线 = 第 %3 次，%4"};
inline constexpr Phrase kHeadQuantity{"quantity, how measured", "Größe, Messweg", "grandeur, méthode", "magnitud, método", "量值与测法"};
inline constexpr Phrase kHeadToday{"today", "heute", "ce jour", "hoy", "本次"};
inline constexpr Phrase kHeadInterval{"95 % interval, unit", "95-%-Intervall, Einheit", "intervalle à 95 %, unité", "intervalo 95 %, unidad", "95% 区间，单位"};
inline constexpr Phrase kHeadPrevious{"previous", "vorher", "précédente", "previa", "上次"};
inline constexpr Phrase kHeadChange{"change", "Änderung", "changement", "cambio", "变化"};
inline constexpr Phrase kHeadSdc{"SDC", "KNÄ", "PCD", "MCD", "SDC"};
inline constexpr Phrase kHeadBaseline{"baseline", "Ausgang", "initiale", "inicial", "基线"};
inline constexpr Phrase kHeadPercent{"% of baseline", "% des Ausgangs", "% de l’initiale", "% de la inicial", "占基线 %"};
inline constexpr Phrase kArea{"Area, opening", "Fläche der Öffnung", "Surface, ouverture", "Área, abertura", "开口面积"};
inline constexpr Phrase kAreaHow{"reference skin inside the outline", "Referenzhaut innerhalb des Umrisses", "peau de référence dans le contour", "piel de referencia en el contorno", "轮廓内的参考皮面"};
inline constexpr Phrase kBedArea{"Area, bed", "Fläche des Grunds", "Surface, fond", "Área, lecho", "创基面积"};
inline constexpr Phrase kBedAreaHow{"surface of the bed inside the outline", "Wundgrund innerhalb des Umrisses", "surface du fond dans le contour", "superficie del lecho en el contorno", "轮廓内的创基表面"};
inline constexpr Phrase kProjected{"Area, projected", "Fläche, projiziert", "Surface, projetée", "Área, proyectada", "投影面积"};
inline constexpr Phrase kProjectedHow{"best-fit plane, as a photograph gives", "Ausgleichsebene, wie im Foto", "plan moyen, comme une photo", "plano medio, como en una foto", "最佳拟合平面，同照片"};
inline constexpr Phrase kPerimeter{"Perimeter", "Umfang", "Périmètre", "Perímetro", "周长"};
inline constexpr Phrase kPerimeterHow{"along the surface", "entlang der Oberfläche", "le long de la surface", "a lo largo de la superficie", "沿表面"};
inline constexpr Phrase kLengthWidth{"Length × width", "Länge × Breite", "Longueur × largeur", "Longitud × anchura", "长 × 宽"};
inline constexpr Phrase kLengthWidthHow{"greatest chord × perpendicular", "größte Sehne × senkrechte Sehne", "plus grande corde × perpendiculaire", "mayor cuerda × perpendicular", "最大弦 × 垂直弦"};
inline constexpr Phrase kClockLength{"Length × width, clock", "Länge × Breite, Uhr", "Longueur × largeur, cadran", "Longitud × anchura, reloj", "长 × 宽（钟面）"};
inline constexpr Phrase kClockLengthHow{"heel–toe axis × perpendicular", "Achse Ferse–Zehen × senkrecht", "axe talon–orteils × perpendiculaire", "eje talón–dedos × perpendicular", "跟趾轴 × 垂直方向"};
inline constexpr Phrase kVolume{"Volume below skin", "Volumen unter Hautniveau", "Volume sous la peau", "Volumen bajo la piel", "皮面以下容积"};
inline constexpr Phrase kVolumeHow{"between bed and reference skin", "zwischen Grund und Referenzhaut", "entre fond et peau de référence", "entre lecho y piel de referencia", "创基与参考皮面之间"};
inline constexpr Phrase kVolumeAbove{"Volume above skin", "Volumen über Hautniveau", "Volume au-dessus de la peau", "Volumen sobre la piel", "皮面以上容积"};
inline constexpr Phrase kVolumeAboveHow{"reported apart, never subtracted", "getrennt, nie abgezogen", "à part, jamais soustrait", "aparte, nunca se resta", "单独报告，不相减"};
inline constexpr Phrase kDepth{"Depth, greatest", "Größte Tiefe", "Profondeur maximale", "Profundidad máxima", "最大深度"};
inline constexpr Phrase kDepthHow{"along the normal of the reference skin", "entlang der Hautnormale", "selon la normale de la peau", "según la normal de la piel", "沿参考皮面法线"};
inline constexpr Phrase kDepth99{"Depth, 99th percentile", "Tiefe, 99. Perzentil", "Profondeur, 99e centile", "Profundidad, percentil 99", "深度，第 99 百分位"};
inline constexpr Phrase kDepth99How{"robust to single points", "robust gegen Einzelpunkte", "robuste aux points isolés", "robusto a puntos aislados", "不受个别点影响"};
inline constexpr Phrase kDepthMean{"Depth, mean", "Mittlere Tiefe", "Profondeur moyenne", "Profundidad media", "平均深度"};
inline constexpr Phrase kDepthMeanHow{"volume below skin ÷ area, opening", "Volumen ÷ Fläche der Öffnung", "volume ÷ surface, ouverture", "volumen ÷ área, abertura", "容积 ÷ 开口面积"};
inline constexpr Phrase kBedUnseen{"Bed not seen", "Grund nicht gesehen", "Fond non vu", "Lecho no visto", "未见到的创基"};
inline constexpr Phrase kBedUnseenHow{"share of the bed; limit 10 %", "Anteil am Grund; Grenze 10 %", "part du fond ; limite 10 %", "parte del lecho; límite 10 %", "占创基比例；上限 10%"};
inline constexpr Phrase kOfTheBed{"of the bed", "des Grunds", "du fond", "del lecho", "（创基）"};
inline constexpr Phrase kUndermining{"Undermining", "Unterminierung", "Décollement", "Socavamiento", "潜行"};
inline constexpr Phrase kTunnel{"Tunnel", "Tunnel", "Tunnel", "Túnel", "窦道"};
inline constexpr Phrase kByProbe{"by probe, typed; light cannot see it", "mit der Sonde, eingegeben", "au stylet, saisi", "con sonda, escrito", "探针测得，手工录入"};
inline constexpr Phrase kNone{"none", "keine", "aucun", "ninguno", "无"};
inline constexpr Phrase kOClock{"%1 o’clock", "%1 Uhr", "%1 h", "a las %1", "%1 点"};
inline constexpr Phrase kPrimary{"(primary)", "(Hauptgröße)", "(principale)", "(principal)", "（主要）"};
inline constexpr Phrase kIntervalNote{"Interval: 95 %, from the outline ± 0.5 mm, the skin curve ± 1 mm and the uncertainty of the model.", "Intervall: 95 %, aus Umriss ± 0,5 mm, Hautkurve ± 1 mm und Unsicherheit des Modells.", "Intervalle : 95 %, d’après le contour ± 0,5 mm, la courbe cutanée ± 1 mm et l’incertitude du modèle.", "Intervalo: 95 %, del contorno ± 0,5 mm, la curva de piel ± 1 mm y la incertidumbre del modelo.", "区间：95%，来自轮廓 ± 0.5 mm、皮肤曲线 ± 1 mm 与模型不确定度。"};
inline constexpr Phrase kChangeNote{"Triangle: a change larger than the smallest detectable change (SDC); ≈ and grey: not distinguishable from no change.", "Dreieck: Änderung größer als die kleinste nachweisbare (KNÄ); ≈ und grau: von keiner Änderung nicht zu unterscheiden.", "Triangle : changement supérieur au plus petit détectable (PCD) ; ≈ et gris : non distinguable d’aucun changement.", "Triángulo: cambio mayor que el menor detectable (MCD); ≈ y gris: no se distingue de ningún cambio.", "三角：变化大于最小可检出变化（SDC）；≈ 与灰色：与无变化无法区分。"};
inline constexpr Phrase kBelowNote{"“<”: not 0, but smaller than the last printed digit.", "„<“: nicht 0, aber kleiner als die letzte gedruckte Stelle.", "« < » : pas 0, mais inférieur au dernier chiffre imprimé.", "«<»: no es 0, sino menor que la última cifra impresa.", "“<”：并非 0，而是小于末位打印数字。"};
inline constexpr Phrase kAtVisitNot{"At visit %1: %2 not measurable.", "Bei Visite %1 nicht messbar: %2.", "À la visite %1, non mesurable : %2.", "En la visita %1, no medible: %2.", "第 %1 次无法测量：%2。"};

// 5 Findings
inline constexpr Phrase kTissueHead{"Tissue, exudate, edge, undermining", "Gewebe, Exsudat, Rand, Unterminierung", "Tissus, exsudat, berge, décollement", "Tejido, exudado, borde, socavamiento", "组织、渗液、边缘、潜行"};
inline constexpr Phrase kTissueShare{"Share of bed area, whole per cent", "Anteil am Wundgrund, ganze Prozent", "Part du fond, pour cent entiers", "Parte del lecho, porcentaje entero", "占创基面积，整数百分比"};
inline constexpr Phrase kTissueNot{"tissue not recorded", "Gewebe nicht erfasst", "tissus non renseignés", "tejido no registrado", "组织未记录"};
inline constexpr Phrase kNotConfirmed{"proposed, not confirmed by a clinician", "vorgeschlagen, nicht bestätigt", "proposé, non confirmé par un clinicien", "propuesto, no confirmado por un clínico", "建议值，未经临床确认"};
inline constexpr Phrase kConfirmed{"confirmed by a clinician", "klinisch bestätigt", "confirmé par un clinicien", "confirmado por un clínico", "经临床确认"};
inline constexpr Phrase kVisitWord{"visit", "Visite", "visite", "visita", "就诊"};
inline constexpr Phrase kVisitToday{"%1 · today", "%1 · heute", "%1 · ce jour", "%1 · hoy", "%1 · 本次"};
inline constexpr Phrase kUnderminingByClock{"Undermining, by clock", "Unterminierung, nach Uhr", "Décollement, par cadran", "Socavamiento, por reloj", "潜行（钟面）"};
inline constexpr Phrase kUnpainted{"not painted", "nicht markiert", "non peint", "sin pintar", "未标注"};

// 6 Scores
inline constexpr Phrase kScores{"Scores", "Scores", "Scores", "Escalas", "评分"};
inline constexpr Phrase kScoresNote{"each item confirmed by the clinician; no verdict by the program", "jeder Punkt klinisch bestätigt; kein Urteil des Programms", "chaque item confirmé par le clinicien ; aucun verdict du programme", "cada ítem confirmado por el clínico; sin veredicto del programa", "各项均由临床人员确认；程序不作判定"};
inline constexpr Phrase kScoreHead{"score, rule", "Score, Regel", "score, règle", "escala, regla", "评分与规则"};
inline constexpr Phrase kComponents{"components", "Komponenten", "composantes", "componentes", "各项"};
inline constexpr Phrase kResult{"result", "Ergebnis", "résultat", "resultado", "结果"};
inline constexpr Phrase kNotComputable{"not computable", "nicht berechenbar", "non calculable", "no calculable", "无法计算"};
inline constexpr Phrase kNoScores{"No score was recorded.", "Kein Score erfasst.", "Aucun score renseigné.", "Ninguna escala registrada.", "未记录评分。"};
inline constexpr Phrase kMissingNote{"? A missing input is never counted as 0. Area and site are proposed from the model, every other item is typed.", "? Eine fehlende Angabe zählt nie als 0. Fläche und Ort schlägt das Modell vor, alles andere wird eingegeben.", "? Une donnée manquante ne compte jamais pour 0. Surface et site sont proposés par le modèle, le reste est saisi.", "? Un dato que falta nunca cuenta como 0. Área y lugar los propone el modelo; lo demás se escribe.", "? 缺失项绝不计为 0。面积与部位由模型建议，其余均为录入。"};

// 7 Trends
inline constexpr Phrase kTrends{"Trends", "Verlauf", "Évolution", "Evolución", "趋势"};
inline constexpr Phrase kTrendsNote{"%1 visits, %2 – %3 · open: earlier visits, filled: today", "%1 Visiten, %2 – %3 · offen: früher, gefüllt: heute", "%1 visites, %2 – %3 · vide : antérieures, plein : ce jour", "%1 visitas, %2 – %3 · vacío: anteriores, lleno: hoy", "%1 次就诊，%2 – %3 · 空心：以往，实心：本次"};
inline constexpr Phrase kVisitOutline{"Visit, outline", "Visite, Umriss", "Visite, contour", "Visita, contorno", "就诊，轮廓"};
inline constexpr Phrase kToesUp{"1 : %1, toes up", "1 : %1, Zehen oben", "1 : %1, orteils en haut", "1 : %1, dedos arriba", "1 : %1，足趾朝上"};
inline constexpr Phrase kNotOriented{"1 : %1", "1 : %1", "1 : %1", "1 : %1", "1 : %1"};
inline constexpr Phrase kTArea{"Area", "Fläche", "Surface", "Área", "面积"};
inline constexpr Phrase kTAreaUnit{"opening, cm²", "Öffnung, cm²", "ouverture, cm²", "abertura, cm²", "开口，cm²"};
inline constexpr Phrase kTVolume{"Volume", "Volumen", "Volume", "Volumen", "容积"};
inline constexpr Phrase kTVolumeUnit{"below skin, %1", "unter Haut, %1", "sous la peau, %1", "bajo la piel, %1", "皮面以下，%1"};
inline constexpr Phrase kTDepth{"Depth", "Tiefe", "Profondeur", "Profundidad", "深度"};
inline constexpr Phrase kTDepthUnit{"greatest, mm", "größte, mm", "maximale, mm", "máxima, mm", "最大，mm"};
inline constexpr Phrase kWeek{"week", "Woche", "semaine", "semana", "周"};
inline constexpr Phrase kEvents{"events", "Ereignisse", "événements", "eventos", "事件"};
inline constexpr Phrase kNm{"n. m.", "n. m.", "n. m.", "n. m.", "未测"};
inline constexpr Phrase kHalfMark{"50 % of baseline at 4 weeks ¹ ²", "50 % des Ausgangs nach 4 Wochen ¹ ²", "50 % de l’initiale à 4 semaines ¹ ²", "50 % de la inicial a 4 semanas ¹ ²", "4 周时为基线的 50% ¹ ²"};
inline constexpr Phrase kTenthMark{"10 % left at 8 weeks ³", "10 % übrig nach 8 Wochen ³", "10 % restants à 8 semaines ³", "queda 10 % a 8 semanas ³", "8 周时余 10% ³"};
inline constexpr Phrase kHalfShort{"50 %, 4 wk ¹ ²", "50 %, 4 Wo. ¹ ²", "50 %, 4 sem. ¹ ²", "50 %, 4 sem. ¹ ²", "50%，4 周 ¹ ²"};
inline constexpr Phrase kTenthShort{"10 % left, 8 wk ³", "10 % übrig, 8 Wo. ³", "10 % restants, 8 sem. ³", "queda 10 %, 8 sem. ³", "余 10%，8 周 ³"};
inline constexpr Phrase kAreaReduction{"Area reduction", "Flächenabnahme", "Réduction de surface", "Reducción del área", "面积缩小"};
inline constexpr Phrase kReductionValue{"%1, %2 days", "%1, %2 Tage", "%1, %2 jours", "%1, %2 días", "%1，%2 天"};
inline constexpr Phrase kAdvance{"Linear advance (visits)", "Randvorschub (Visiten)", "Avance linéaire (visites)", "Avance lineal (visitas)", "线性推进（就诊）"};
inline constexpr Phrase kAdvanceValue{"%1 mm/wk (%2 to %3)", "%1 mm/Wo. (%2 bis %3)", "%1 mm/sem. (%2 à %3)", "%1 mm/sem. (%2 a %3)", "%1 mm/周（%2 至 %3）"};
inline constexpr Phrase kRate{"Rate ln(A₀/A)/t", "Rate ln(A₀/A)/t", "Taux ln(A₀/A)/t", "Tasa ln(A₀/A)/t", "速率 ln(A₀/A)/t"};
inline constexpr Phrase kPerWeek{"%1 per week", "%1 pro Woche", "%1 par semaine", "%1 por semana", "每周 %1"};
inline constexpr Phrase kFit{"Exponential fit, rate b", "Exponentielle Anpassung, b", "Ajustement exponentiel, b", "Ajuste exponencial, b", "指数拟合速率 b"};
inline constexpr Phrase kClosure{"Closure date", "Verschlussdatum", "Date de fermeture", "Fecha de cierre", "闭合日期"};
inline constexpr Phrase kNoClosure{"none before 5 visits", "nicht vor 5 Visiten", "aucune avant 5 visites", "ninguna antes de 5 visitas", "少于 5 次就诊不给出"};
inline constexpr Phrase kClosureNever{"not predicted", "keine Vorhersage", "non prédite", "no se predice", "不作预测"};
inline constexpr Phrase kTrendNotes{"Bars: 95 % interval. × not measurable; the line is broken there. SDC: a change smaller than this bar cannot be told from none. No line is drawn beyond the last visit. Linear advance after Gilman.", "Balken: 95-%-Intervall. × nicht messbar; dort ist die Linie unterbrochen. KNÄ: eine kleinere Änderung ist von keiner nicht zu unterscheiden. Keine Linie nach der letzten Visite. Randvorschub nach Gilman.", "Barres : intervalle à 95 %. × non mesurable ; la ligne y est interrompue. PCD : un changement plus petit ne se distingue pas d’aucun. Aucune ligne après la dernière visite. Avance linéaire selon Gilman.", "Barras: intervalo 95 %. × no medible; allí se interrumpe la línea. MCD: un cambio menor no se distingue de ninguno. Ninguna línea tras la última visita. Avance lineal según Gilman.", "误差棒：95% 区间。× 无法测量，该处连线中断。SDC：小于此棒的变化与无变化无法区分。末次就诊后不画线。线性推进按 Gilman。"};
inline constexpr Phrase kMoreEvents{"%1 more in the record", "%1 weitere im Datensatz", "%1 autres dans le dossier", "%1 más en el registro", "记录中另有 %1 项"};
inline constexpr Phrase kNotPrediction{"Published group figures, not a prediction.", "Publizierte Gruppenwerte, keine Vorhersage.", "Chiffres de groupe publiés, pas une prédiction.", "Cifras de grupo publicadas, no una predicción.", "已发表的群体数据，并非预测。"};
inline constexpr Phrase kCitations{"1 Sheehan et al., Diabetes Care 2003;26:1879–82: n = 203, midpoint 53 %; 58 % healed at 12 weeks above the group’s median reduction, 9 % below. 2 Coerper et al., J Diabetes Complications 2009;23:49–53: n = 704, cut 50 %: 52.3 % and 18.4 %. 3 Warriner et al.: less than 90 % at 8 weeks, NPV 82 %.", "1 Sheehan et al., Diabetes Care 2003;26:1879–82: n = 203, Mitte 53 %; 58 % nach 12 Wochen geheilt oberhalb der medianen Abnahme der Gruppe, 9 % darunter. 2 Coerper et al., J Diabetes Complications 2009;23:49–53: n = 704, Schnitt 50 %: 52,3 % und 18,4 %. 3 Warriner et al.: weniger als 90 % nach 8 Wochen, NPW 82 %.", "1 Sheehan et al., Diabetes Care 2003;26:1879–82 : n = 203, milieu 53 % ; 58 % guéris à 12 semaines au-dessus de la réduction médiane du groupe, 9 % en dessous. 2 Coerper et al., J Diabetes Complications 2009;23:49–53 : n = 704, seuil 50 % : 52,3 % et 18,4 %. 3 Warriner et al. : moins de 90 % à 8 semaines, VPN 82 %.", "1 Sheehan et al., Diabetes Care 2003;26:1879–82: n = 203, punto medio 53 %; 58 % curados a las 12 semanas por encima de la reducción mediana del grupo, 9 % por debajo. 2 Coerper et al., J Diabetes Complications 2009;23:49–53: n = 704, corte 50 %: 52,3 % y 18,4 %. 3 Warriner et al.: menos de 90 % a 8 semanas, VPN 82 %.", "1 Sheehan 等，Diabetes Care 2003;26:1879–82：n = 203，中点 53%；缩小高于组内中位数者 12 周愈合 58%，低于者 9%。2 Coerper 等，J Diabetes Complications 2009;23:49–53：n = 704，界值 50%：52.3% 与 18.4%。3 Warriner 等：8 周不足 90%，阴性预测值 82%。"};

// 8 Comparison
inline constexpr Phrase kComparison{"Comparison", "Vergleich", "Comparaison", "Comparación", "比较"};
inline constexpr Phrase kComparisonNote{"visit %1 (%2) with visit %3 (%4), registered on skin", "Visite %1 (%2) mit Visite %3 (%4), an der Haut ausgerichtet", "visite %1 (%2) avec visite %3 (%4), recalées sur la peau", "visita %1 (%2) con visita %3 (%4), registradas en la piel", "第 %1 次（%2）与第 %3 次（%4），按皮肤配准"};
inline constexpr Phrase kVisitPicture{"Visit %1, %2", "Visite %1, %2", "Visite %1, %2", "Visita %1, %2", "第 %1 次，%2"};
inline constexpr Phrase kDashesAre{"dashes: outline of visit %1", "gestrichelt: Umriss von Visite %1", "tirets : contour de la visite %1", "discontinua: contorno de la visita %1", "虚线：第 %1 次轮廓"};
inline constexpr Phrase kChangeOfSurface{"Change of the surface, mm, %1", "Änderung der Oberfläche, mm, %1", "Changement de la surface, mm, %1", "Cambio de la superficie, mm, %1", "表面变化，mm，%1"};
inline constexpr Phrase kNotDetectable{"± %1 not detectable", "± %1 nicht nachweisbar", "± %1 non détectable", "± %1 no detectable", "± %1 不可检出"};
inline constexpr Phrase kOutward{"+ blue: further out (filled, callus).", "+ blau: weiter außen (gefüllt, Schwiele).", "+ bleu : plus à l’extérieur (comblé, cal).", "+ azul: más afuera (relleno, callo).", "+ 蓝：更靠外（填充、胼胝）。"};
inline constexpr Phrase kInward{"− orange, hatched: deeper.", "− orange, schraffiert: tiefer.", "− orange, hachuré : plus profond.", "− naranja, rayado: más profundo.", "− 橙，斜线：更深。"};
inline constexpr Phrase kDotted{"Dotted line: limit of detection, %1 mm.", "Punktiert: Nachweisgrenze, %1 mm.", "Pointillé : limite de détection, %1 mm.", "Punteada: límite de detección, %1 mm.", "点线：检出限 %1 mm。"};
inline constexpr Phrase kClock{"clock", "Uhr", "cadran", "reloj", "钟面"};
inline constexpr Phrase kEdge{"edge\nmm", "Rand\nmm", "bord\nmm", "borde\nmm", "边缘\nmm"};
inline constexpr Phrase kEdgeWeek{"edge\nmm/wk", "Rand\nmm/Wo.", "bord\nmm/sem.", "borde\nmm/sem.", "边缘\nmm/周"};
inline constexpr Phrase kGain{"gain\nmm³", "Zunahme\nmm³", "gain\nmm³", "ganancia\nmm³", "增加\nmm³"};
inline constexpr Phrase kLoss{"loss\nmm³", "Verlust\nmm³", "perte\nmm³", "pérdida\nmm³", "减少\nmm³"};
inline constexpr Phrase kAll{"all", "alle", "total", "total", "合计"};
inline constexpr Phrase kRegistration{"Registration", "Ausrichtung", "Recalage", "Registro", "配准"};
inline constexpr Phrase kRegistrationOn{"skin 10–60 mm from the wound; wound, callus, toes left out. Residual %1 mm RMS (limit 0.7), inliers %2 (limit 60).", "Haut 10–60 mm um die Wunde; Wunde, Schwiele, Zehen ausgelassen. Residuum %1 mm RMS (Grenze 0,7), Inlier %2 (Grenze 60).", "peau à 10–60 mm de la plaie ; plaie, cal, orteils exclus. Résidu %1 mm RMS (limite 0,7), points concordants %2 (limite 60).", "piel a 10–60 mm de la herida; sin herida, callo ni dedos. Residuo %1 mm RMS (límite 0,7), concordantes %2 (límite 60).", "距创面 10–60 mm 的皮肤；不含创面、胼胝、足趾。残差 %1 mm RMS（上限 0.7），内点 %2（下限 60）。"};
inline constexpr Phrase kAccepted{"Accepted.", "Angenommen.", "Accepté.", "Aceptado.", "已接受。"};
inline constexpr Phrase kRefused{"Refused", "Abgelehnt", "Refusé", "Rechazado", "已拒绝"};
inline constexpr Phrase kNoSectors{"No sectors", "Keine Sektoren", "Pas de secteurs", "Sin sectores", "无扇区"};
inline constexpr Phrase kNoMap{"No map", "Keine Karte", "Pas de carte", "Sin mapa", "无变化图"};
inline constexpr Phrase kNoComparison{"No comparison was made.", "Kein Vergleich durchgeführt.", "Aucune comparaison effectuée.", "No se hizo ninguna comparación.", "未作比较。"};

// 9 to 12
inline constexpr Phrase kNotesAndPlan{"Notes and plan", "Notizen und Plan", "Notes et plan", "Notas y plan", "备注与计划"};
inline constexpr Phrase kSeeNine{"(in full in 9)", "(vollständig unter 9)", "(en entier en 9)", "(completo en 9)", "（全文见第 9 节）"};
inline constexpr Phrase kNotes{"Notes", "Notizen", "Notes", "Notas", "备注"};
inline constexpr Phrase kPlan{"Plan", "Plan", "Plan", "Plan", "计划"};
inline constexpr Phrase kQuality{"Quality and method", "Qualität und Methode", "Qualité et méthode", "Calidad y método", "质量与方法"};
inline constexpr Phrase kReferenceSkin{"Reference skin", "Referenzhaut", "Peau de référence", "Piel de referencia", "参考皮面"};
inline constexpr Phrase kFit4Measurement{"Fit for measurement", "Zum Messen geeignet", "Apte à la mesure", "Apto para medir", "适合测量"};
inline constexpr Phrase kYes{"yes", "ja", "oui", "sí", "是"};
inline constexpr Phrase kNo{"no", "nein", "non", "no", "否"};
inline constexpr Phrase kScanSha{"scan SHA-256", "Aufnahme SHA-256", "numérisation SHA-256", "escaneo SHA-256", "扫描 SHA-256"};
inline constexpr Phrase kModelSha{"model SHA-256", "Modell SHA-256", "modèle SHA-256", "modelo SHA-256", "模型 SHA-256"};
inline constexpr Phrase kRecordSha{"record SHA-256", "Datensatz SHA-256", "dossier SHA-256", "registro SHA-256", "记录 SHA-256"};
inline constexpr Phrase kMethodText{
  "The foot was reconstructed from a depth-camera scan as one coloured surface. The wound outline was traced on it and the surface cut exactly along it. The reference skin continues the healthy skin outside the skin curve over the wound, following the curvature of the foot. Volume lies between bed and reference skin; depth is taken along the normal of the reference skin.",
  "Der Fuß wurde aus einer Tiefenkamera-Aufnahme als eine farbige Oberfläche rekonstruiert. Der Wundumriss wurde darauf gezeichnet und die Oberfläche genau daran geschnitten. Die Referenzhaut führt die gesunde Haut außerhalb der Hautkurve über die Wunde fort und folgt der Krümmung des Fußes. Das Volumen liegt zwischen Wundgrund und Referenzhaut; die Tiefe wird entlang der Normale der Referenzhaut gemessen.",
  "Le pied a été reconstruit à partir d’une caméra de profondeur en une seule surface colorée. Le contour de la plaie y a été tracé et la surface découpée exactement selon lui. La peau de référence prolonge la peau saine extérieure à la courbe cutanée au-dessus de la plaie en suivant la courbure du pied. Le volume est compris entre fond et peau de référence ; la profondeur est prise selon la normale de celle-ci.",
  "El pie se reconstruyó a partir de una cámara de profundidad como una sola superficie en color. Sobre ella se trazó el contorno de la herida y la superficie se cortó exactamente por él. La piel de referencia continúa la piel sana exterior a la curva de piel sobre la herida, siguiendo la curvatura del pie. El volumen está entre lecho y piel de referencia; la profundidad se toma según la normal de esta.",
  "足部由深度相机扫描重建为一个彩色曲面。创面轮廓在曲面上描出，曲面沿轮廓精确切开。参考皮面将皮肤曲线外的健康皮肤顺足部曲率延续到创面之上。容积为创基与参考皮面之间的体积；深度沿参考皮面法线测量。"};
inline constexpr Phrase kPhantoms{"accuracy on the listed phantoms: computer-made feet, 600 simulated frames, true outline and skin", "Genauigkeit an den aufgeführten Phantomen: Füße vom Rechner, 600 simulierte Bilder, wahrer Umriss und wahre Haut", "exactitude sur les fantômes cités : pieds calculés, 600 images simulées, contour et peau vrais", "exactitud en los fantomas citados: pies por ordenador, 600 imágenes simuladas, contorno y piel verdaderos", "所列体模的准确度：计算机生成的足，600 帧模拟，真实轮廓与皮肤"};
inline constexpr Phrase kTrueVolume{"true volume", "wahres Volumen", "volume vrai", "volumen real", "真实容积"};
inline constexpr Phrase kTrueDepth{"true depth", "wahre Tiefe", "profondeur vraie", "profundidad real", "真实深度"};
inline constexpr Phrase kError{"error", "Fehler", "erreur", "error", "误差"};
inline constexpr Phrase kNoPhantomCheck{"This camera: no phantom check recorded.", "Diese Kamera: keine Phantomprüfung erfasst.", "Cette caméra : aucun contrôle sur fantôme enregistré.", "Esta cámara: ninguna comprobación con fantoma registrada.", "本相机：未记录体模检查。"};
inline constexpr Phrase kUnfitReason{"Not fit for measurement", "Zum Messen ungeeignet", "Impropre à la mesure", "No apto para medir", "不适合测量"};
inline constexpr Phrase kNote{"Note.", "Hinweis.", "Remarque.", "Nota.", "注意："};
inline constexpr Phrase kNoWarnings{"No warnings.", "Keine Warnungen.", "Aucun avertissement.", "Sin advertencias.", "无警告。"};
inline constexpr Phrase kSignatures{"Signatures and amendments", "Signaturen und Nachträge", "Signatures et amendements", "Firmas y enmiendas", "签名与修订"};
inline constexpr Phrase kHeadVersion{"version", "Version", "version", "versión", "版本"};
inline constexpr Phrase kHeadWhat{"what", "was", "quoi", "qué", "内容"};
inline constexpr Phrase kHeadWho{"who", "wer", "qui", "quién", "人员"};
inline constexpr Phrase kHeadWhen{"when", "wann", "quand", "cuándo", "时间"};
inline constexpr Phrase kHeadKey{"signature", "Signatur", "signature", "firma", "签名"};
inline constexpr Phrase kWasSigned{"signed", "signiert", "signé", "firmado", "签名"};
inline constexpr Phrase kCountersigned{"countersigned", "gegengezeichnet", "contresigné", "refrendado", "复签"};
inline constexpr Phrase kReturned{"returned for a change", "zur Änderung zurückgegeben", "renvoyé pour modification", "devuelto para cambio", "退回修改"};
inline constexpr Phrase kAmendment{"Amendment %1.", "Nachtrag %1.", "Amendement %1.", "Enmienda %1.", "修订 %1。"};
inline constexpr Phrase kReason{"Reason", "Grund", "Raison", "Motivo", "原因"};
inline constexpr Phrase kEffect{"Effect", "Wirkung", "Effet", "Efecto", "影响"};
inline constexpr Phrase kOpenSign{"open: sign here by hand, or in the program", "offen: hier von Hand oder im Programm unterschreiben", "ouvert : signer ici à la main, ou dans le programme", "abierto: firme aquí a mano o en el programa", "待签：在此手签，或在程序中签名"};
inline constexpr Phrase kEarlierStay{"Earlier values stay visible, struck through.", "Frühere Werte bleiben sichtbar, durchgestrichen.", "Les valeurs antérieures restent visibles, barrées.", "Los valores anteriores quedan visibles, tachados.", "先前的值保留可见，以删除线标出。"};
inline constexpr Phrase kFilesHead{"Files of this report", "Dateien zu diesem Bericht", "Fichiers de ce rapport", "Archivos de este informe", "本报告的文件"};
inline constexpr Phrase kHeadFile{"file", "Datei", "fichier", "archivo", "文件"};
inline constexpr Phrase kHeadContent{"content", "Inhalt", "contenu", "contenido", "内容"};
inline constexpr Phrase kHeadSize{"size", "Größe", "taille", "tamaño", "大小"};
inline constexpr Phrase kWhatThisIs{"What this report is", "Was dieser Bericht ist", "Ce qu’est ce rapport", "Qué es este informe", "关于本报告"};
inline constexpr Phrase kRecords{"It records measurements; it gives no verdict on class, severity or healing.", "Er hält Messungen fest und gibt kein Urteil über Klasse, Schweregrad oder Heilung.", "Il consigne des mesures ; il ne donne aucun verdict sur la classe, la gravité ou la guérison.", "Registra mediciones; no da veredicto sobre clase, gravedad o curación.", "本报告记录测量值，不对分级、严重程度或愈合作出判定。"};
inline constexpr Phrase kDraftUntil{"It is a draft until a clinician signs it.", "Er ist ein Entwurf, bis eine Fachperson ihn signiert.", "C’est un brouillon tant qu’un clinicien ne l’a pas signé.", "Es un borrador hasta que lo firme un clínico.", "临床人员签名前为草稿。"};
// clang-format on

}  // namespace tarsus::phrase
