#include "measurement/report/phrases.h"

#include <QRegularExpression>

#include <algorithm>

namespace tarsus::phrase {
namespace {

// What measurement, comparison, reconstruction and scores write in English (the English text here
// is theirs, to the letter); %1 ... stand for their numbers, in this order.
// clang-format off
constexpr Phrase kSentences[] = {
  // Why a quantity has no number
  {"heel and toe were not marked", "Ferse und Zehen nicht markiert", "talon et orteils non marqués", "talón y dedos no marcados", "未标记足跟与足趾"},
  {"heel and toe are marked at the same place", "Ferse und Zehen an derselben Stelle markiert", "talon et orteils marqués au même endroit", "talón y dedos marcados en el mismo punto", "足跟与足趾标在同一处"},
  {"the wound faces along the heel-toe axis", "die Wunde weist in Richtung der Achse Ferse–Zehen", "la plaie est orientée selon l’axe talon–orteils", "la herida mira en la dirección del eje talón–dedos", "创面朝向跟趾轴方向"},
  {"the model does not say which of its parts were seen", "das Modell sagt nicht, welche Teile gesehen wurden", "le modèle ne dit pas quelles parties ont été vues", "el modelo no indica qué partes se vieron", "模型未说明哪些部分被看到"},
  {"%1 % of the wound bed was not seen by the camera", "%1 % des Wundgrunds von der Kamera nicht gesehen", "%1 % du fond non vu par la caméra", "la cámara no vio el %1 % del lecho", "相机未见到 %1% 的创基"},
  // Warnings of a measurement
  {"The model does not carry its own uncertainty or what was seen; %1 mm is assumed.", "Das Modell enthält weder seine Unsicherheit noch, was gesehen wurde; %1 mm werden angenommen.", "Le modèle n’indique ni son incertitude ni ce qui a été vu ; %1 mm est supposé.", "El modelo no indica su incertidumbre ni lo que se vio; se suponen %1 mm.", "模型未含自身不确定度及可见范围；假定为 %1 mm。"},
  {"Volume / area is %1 mm; below 4 mm a volume is less precise than 5 %.", "Volumen ÷ Fläche ist %1 mm; unter 4 mm ist ein Volumen ungenauer als 5 %.", "Volume ÷ surface : %1 mm ; sous 4 mm, un volume est moins précis que 5 %.", "Volumen ÷ área: %1 mm; por debajo de 4 mm un volumen es menos preciso que un 5 %.", "容积 ÷ 面积为 %1 mm；低于 4 mm 时容积精度低于 5%。"},
  {"More of the bed lies above the reference skin than below it: the wound is overgrown, or the faces of this model point inwards; look at the model before you use a number.", "Mehr vom Wundgrund liegt über der Referenzhaut als darunter: Die Wunde ist überwachsen, oder die Flächen des Modells zeigen nach innen; das Modell ansehen, bevor eine Zahl verwendet wird.", "Une plus grande part du fond est au-dessus de la peau de référence qu’en dessous : la plaie bourgeonne, ou les faces du modèle sont inversées ; regarder le modèle avant d’utiliser une valeur.", "Hay más lecho por encima de la piel de referencia que por debajo: la herida está sobreelevada o las caras del modelo miran hacia dentro; mire el modelo antes de usar un número.", "创基高于参考皮面的部分多于低于的部分：创面过度生长，或模型面片朝内；使用数值前请查看模型。"},
  {"The outline lies at a hole or at the edge of the model; scan that place again.", "Der Umriss liegt an einem Loch oder am Rand des Modells; diese Stelle erneut aufnehmen.", "Le contour touche un trou ou le bord du modèle ; numériser à nouveau cet endroit.", "El contorno está en un hueco o en el borde del modelo; escanee de nuevo ese lugar.", "轮廓位于模型的孔洞或边缘；请重新扫描该处。"},
  {"The skin curve runs over raised or sloping skin, as at a callus, at %1 of 8 stretches, first near %2; draw it farther out there, or volume and depth may be wrong.", "Die Hautkurve verläuft in %1 von 8 Abschnitten über erhabene oder abfallende Haut, wie an einer Schwiele, zuerst bei %2; dort weiter außen zeichnen, sonst können Volumen und Tiefe falsch sein.", "La courbe cutanée passe sur une peau surélevée ou en pente, comme un cal, sur %1 des 8 tronçons, d’abord vers %2 ; la tracer plus loin à cet endroit, sinon volume et profondeur peuvent être faux.", "La curva de piel pasa por piel elevada o inclinada, como un callo, en %1 de 8 tramos, primero cerca de %2; trácela más afuera allí, o el volumen y la profundidad pueden ser erróneos.", "皮肤曲线在 8 段中的 %1 段经过隆起或倾斜的皮肤（如胼胝），首处近 %2；请在该处向外绘制，否则容积与深度可能有误。"},
  {"An interval lacks a part: outline or skin curve could not be moved on this surface.", "Einem Intervall fehlt ein Teil: Umriss oder Hautkurve ließ sich auf dieser Oberfläche nicht verschieben.", "Il manque une part à un intervalle : le contour ou la courbe cutanée n’a pas pu être déplacé sur cette surface.", "A un intervalo le falta una parte: el contorno o la curva de piel no se pudo mover en esta superficie.", "某区间不完整：轮廓或皮肤曲线无法在该曲面上移动。"},
  {"The outline was moved by up to %1 mm to lie on the model; check that both belong together.", "Der Umriss wurde um bis zu %1 mm verschoben, um auf dem Modell zu liegen; prüfen, ob beide zusammengehören.", "Le contour a été déplacé de %1 mm au plus pour reposer sur le modèle ; vérifier qu’ils vont ensemble.", "El contorno se movió hasta %1 mm para quedar sobre el modelo; compruebe que ambos se corresponden.", "轮廓移动了最多 %1 mm 以贴合模型；请确认二者相符。"},
  {"The tissue shares are a proposal that no clinician has confirmed.", "Die Gewebeanteile sind ein Vorschlag, den keine Fachperson bestätigt hat.", "Les parts de tissus sont une proposition qu’aucun clinicien n’a confirmée.", "Las proporciones de tejido son una propuesta que ningún clínico ha confirmado.", "组织占比为建议值，未经临床人员确认。"},
  {"The outline is the program's suggestion, which nobody has edited; look at it first.", "Der Umriss ist der Vorschlag des Programms, den niemand bearbeitet hat; zuerst ansehen.", "Le contour est la suggestion du programme, que personne n’a modifiée ; le regarder d’abord.", "El contorno es la sugerencia del programa, que nadie ha editado; mírelo primero.", "轮廓为程序建议，无人编辑过；请先查看。"},
  {"The scan behind this model was refused for measurement; scan again.", "Die Aufnahme zu diesem Modell wurde zum Messen abgelehnt; erneut aufnehmen.", "La numérisation de ce modèle a été refusée pour la mesure ; numériser à nouveau.", "El escaneo de este modelo fue rechazado para medir; escanee de nuevo.", "此模型的扫描被拒绝用于测量；请重新扫描。"},
  // Why a scan is not fit
  {"%1 % of the frames could not be placed (at most %2 %); scan again, moving slowly.", "%1 % der Bilder ließen sich nicht einordnen (höchstens %2 %); erneut und langsam aufnehmen.", "%1 % des images n’ont pas pu être placées (au plus %2 %) ; numériser à nouveau, lentement.", "No se pudo situar el %1 % de las imágenes (como máximo %2 %); escanee de nuevo, despacio.", "%1% 的帧无法定位（上限 %2%）；请缓慢重新扫描。"},
  {"The frames disagree by %1 mm (at most %2 mm); scan again with the foot kept still.", "Die Bilder weichen um %1 mm voneinander ab (höchstens %2 mm); mit ruhigem Fuß erneut aufnehmen.", "Les images diffèrent de %1 mm (au plus %2 mm) ; numériser à nouveau, le pied immobile.", "Las imágenes difieren en %1 mm (como máximo %2 mm); escanee de nuevo con el pie quieto.", "各帧相差 %1 mm（上限 %2 mm）；请保持足部静止重新扫描。"},
  {"Where the camera came back, the surface is %1 mm off (at most %2 mm); scan again, moving slowly, with the foot kept still.", "Wo die Kamera zurückkam, liegt die Oberfläche %1 mm daneben (höchstens %2 mm); langsam und mit ruhigem Fuß erneut aufnehmen.", "Là où la caméra est revenue, la surface est décalée de %1 mm (au plus %2 mm) ; numériser à nouveau, lentement, le pied immobile.", "Donde la cámara volvió, la superficie se desvía %1 mm (como máximo %2 mm); escanee de nuevo, despacio y con el pie quieto.", "相机返回处曲面偏差 %1 mm（上限 %2 mm）；请缓慢并保持足部静止重新扫描。"},
  {"Where the camera came back, the surface does not fit what it saw before; scan again, moving slowly, with the foot kept still.", "Wo die Kamera zurückkam, passt die Oberfläche nicht zum vorher Gesehenen; langsam und mit ruhigem Fuß erneut aufnehmen.", "Là où la caméra est revenue, la surface ne correspond pas à ce qu’elle avait vu ; numériser à nouveau, lentement, le pied immobile.", "Donde la cámara volvió, la superficie no encaja con lo visto antes; escanee de nuevo, despacio y con el pie quieto.", "相机返回处曲面与先前所见不符；请缓慢并保持足部静止重新扫描。"},
  {"Frames contradict each other about where the surface is (%1 % of the frames; in the middle frame %2 % of the surface); scan again, moving slowly, with the foot kept still.", "Bilder widersprechen sich, wo die Oberfläche liegt (%1 % der Bilder; im mittleren Bild %2 % der Oberfläche); langsam und mit ruhigem Fuß erneut aufnehmen.", "Des images se contredisent sur la position de la surface (%1 % des images ; dans l’image médiane %2 % de la surface) ; numériser à nouveau, lentement, le pied immobile.", "Las imágenes se contradicen sobre dónde está la superficie (%1 % de las imágenes; en la imagen mediana %2 % de la superficie); escanee de nuevo, despacio y con el pie quieto.", "各帧对曲面位置相互矛盾（%1% 的帧；中位帧中 %2% 的曲面）；请缓慢并保持足部静止重新扫描。"},
  {"%1 % of the surface was seen by no sharp picture (at most %2 %); scan again from more sides.", "%1 % der Oberfläche zeigt kein scharfes Bild (höchstens %2 %); von mehr Seiten erneut aufnehmen.", "%1 % de la surface n’a été vue sur aucune image nette (au plus %2 %) ; numériser à nouveau de plus de côtés.", "Ninguna imagen nítida muestra el %1 % de la superficie (como máximo %2 %); escanee de nuevo desde más lados.", "%1% 的曲面没有清晰图像（上限 %2%）；请从更多方向重新扫描。"},
  // Without a scan
  {"no usable scan", "keine brauchbare Aufnahme", "pas de numérisation utilisable", "sin escaneo utilizable", "无可用扫描"},
  {"Without a usable scan of this visit and of an earlier one no surfaces can be compared.", "Ohne brauchbare Aufnahme dieser und einer früheren Visite sind keine Oberflächen vergleichbar.", "Sans numérisation utilisable de cette visite et d’une visite antérieure, aucune surface ne peut être comparée.", "Sin un escaneo utilizable de esta visita y de una anterior no se pueden comparar superficies.", "本次与先前就诊缺少可用扫描，无法比较表面。"},
  // The comparison
  {"the registration was refused", "die Ausrichtung wurde abgelehnt", "le recalage a été refusé", "el registro fue rechazado", "配准被拒绝"},
  {"clock directions need the heel and toe landmarks", "Richtungen der Uhr brauchen die Marken an Ferse und Zehen", "les directions du cadran exigent les repères du talon et des orteils", "las direcciones del reloj necesitan las marcas de talón y dedos", "钟面方向需要足跟与足趾标志点"},
  {"too little skin was scanned between 10 and 60 mm from the wound", "zu wenig Haut zwischen 10 und 60 mm um die Wunde aufgenommen", "trop peu de peau numérisée entre 10 et 60 mm de la plaie", "se escaneó muy poca piel entre 10 y 60 mm de la herida", "距创面 10–60 mm 的皮肤扫描过少"},
  {"Only %1 % of the skin around the wound fits (%2 % are needed): check that both models show the same foot and wound, or give 3 pairs of points by hand.", "Nur %1 % der Haut um die Wunde passen (%2 % sind nötig): prüfen, ob beide Modelle denselben Fuß und dieselbe Wunde zeigen, oder 3 Punktpaare von Hand angeben.", "Seulement %1 % de la peau autour de la plaie concorde (%2 % nécessaires) : vérifier que les deux modèles montrent le même pied et la même plaie, ou donner 3 paires de points à la main.", "Solo encaja el %1 % de la piel alrededor de la herida (se necesita %2 %): compruebe que ambos modelos muestran el mismo pie y la misma herida, o dé 3 pares de puntos a mano.", "创周皮肤仅 %1% 吻合（需 %2%）：请确认两模型为同一足同一创面，或手动给出 3 对点。"},
  {"The skin of the two visits lies %1 mm apart (RMS; %2 mm are allowed): check that both models show the same foot, or give 3 pairs of points by hand.", "Die Haut der beiden Visiten liegt %1 mm auseinander (RMS; erlaubt sind %2 mm): prüfen, ob beide Modelle denselben Fuß zeigen, oder 3 Punktpaare von Hand angeben.", "La peau des deux visites est distante de %1 mm (RMS ; %2 mm admis) : vérifier que les deux modèles montrent le même pied, ou donner 3 paires de points à la main.", "La piel de las dos visitas dista %1 mm (RMS; se admiten %2 mm): compruebe que ambos modelos muestran el mismo pie, o dé 3 pares de puntos a mano.", "两次就诊皮肤相距 %1 mm（RMS；允许 %2 mm）：请确认两模型为同一足，或手动给出 3 对点。"},
  {"The skin around the wound is so even that one visit can slide along the other: scan more of the foot around the wound.", "Die Haut um die Wunde ist so eben, dass eine Visite an der anderen gleiten kann: mehr vom Fuß um die Wunde aufnehmen.", "La peau autour de la plaie est si uniforme qu’une visite peut glisser sur l’autre : numériser davantage le pied autour de la plaie.", "La piel alrededor de la herida es tan uniforme que una visita puede deslizarse sobre la otra: escanee más pie alrededor de la herida.", "创周皮肤过于平坦，两次就诊可相互滑动：请扫描创面周围更大范围的足部。"},
  {"The skin fits nearly as well in another position: scan more of the foot around the wound, or give 3 pairs of points by hand.", "Die Haut passt in einer anderen Lage fast ebenso gut: mehr vom Fuß um die Wunde aufnehmen oder 3 Punktpaare von Hand angeben.", "La peau concorde presque aussi bien dans une autre position : numériser davantage le pied autour de la plaie, ou donner 3 paires de points à la main.", "La piel encaja casi igual de bien en otra posición: escanee más pie alrededor de la herida, o dé 3 pares de puntos a mano.", "皮肤在另一位置几乎同样吻合：请扫描更大范围，或手动给出 3 对点。"},
  {"A pair of points set by hand lies %1 mm apart once the skin fits: check the pairs.", "Ein von Hand gesetztes Punktpaar liegt %1 mm auseinander, wenn die Haut passt: die Paare prüfen.", "Une paire de points placée à la main est distante de %1 mm une fois la peau recalée : vérifier les paires.", "Un par de puntos puesto a mano dista %1 mm una vez encajada la piel: compruebe los pares.", "皮肤吻合后，一对手动点相距 %1 mm：请检查点对。"},
  // Quality of the scan
  {"%1 of %2", "%1 von %2", "%1 sur %2", "%1 de %2", "%1/%2"},
  {"%1 mm", "%1 mm", "%1 mm", "%1 mm", "%1 mm"},
  {"%1 %", "%1 %", "%1 %", "%1 %", "%1%"},
  {"Frames placed", "Eingeordnete Bilder", "Images placées", "Imágenes situadas", "已定位帧"},
  {"Tracking residual", "Restfehler der Verfolgung", "Résidu du suivi", "Residuo de seguimiento", "跟踪残差"},
  {"Voxel size", "Voxelgröße", "Taille du voxel", "Tamaño de vóxel", "体素尺寸"},
  {"Keyframes for the texture", "Bilder für die Textur", "Images pour la texture", "Imágenes para la textura", "纹理关键帧"},
  {"Surface not seen by them", "Davon nicht gesehen", "Surface non vue par elles", "Superficie no vista por ellas", "其中未见表面"},
  {"Camera", "Kamera", "Caméra", "Cámara", "相机"},
  {"Tarsus simulator", "Simulator von Tarsus", "simulateur de Tarsus", "simulador de Tarsus", "Tarsus 模拟器"},
  {"%1; skin curve drawn by hand", "%1; Hautkurve von Hand gezeichnet", "%1 ; courbe cutanée tracée à la main", "%1; curva de piel trazada a mano", "%1；皮肤曲线为手绘"},
  {"%1; skin curve %2 mm outside the outline", "%1; Hautkurve %2 mm außerhalb des Umrisses", "%1 ; courbe cutanée à %2 mm du contour", "%1; curva de piel a %2 mm del contorno", "%1；皮肤曲线在轮廓外 %2 mm"},
  // Scores
  {"grade %1, stage %2", "Grad %1, Stadium %2", "grade %1, stade %2", "grado %1, estadio %2", "%1 级 %2 期"},
  {"grade %1", "Grad %1", "grade %1", "grado %1", "%1 级"},
  {"%1, stage %2", "%1, Stadium %2", "%1, stade %2", "%1, estadio %2", "%1，%2 期"},
  {"length x width %1 cm2", "Länge × Breite %1 cm²", "longueur × largeur %1 cm²", "longitud × anchura %1 cm²", "长 × 宽 %1 cm²"},
  {"osteomyelitis with fewer than two local signs is not covered by this rule; the guideline treats it in a note of its own", "Osteomyelitis mit weniger als zwei lokalen Zeichen erfasst diese Regel nicht; die Leitlinie behandelt sie in einer eigenen Anmerkung", "une ostéomyélite avec moins de deux signes locaux n’est pas couverte par cette règle ; la recommandation la traite dans une note à part", "la osteomielitis con menos de dos signos locales no está cubierta por esta regla; la guía la trata en una nota aparte", "局部体征少于两项的骨髓炎不在本规则范围内；指南另有说明"},
  {"the rule has no grade for abscess or osteomyelitis without a deep ulcer; check the depth", "die Regel hat keinen Grad für Abszess oder Osteomyelitis ohne tiefes Ulkus; die Tiefe prüfen", "la règle n’a pas de grade pour un abcès ou une ostéomyélite sans ulcère profond ; vérifier la profondeur", "la regla no tiene grado para absceso u osteomielitis sin úlcera profunda; compruebe la profundidad", "规则中无深溃疡的脓肿或骨髓炎无分级；请核对深度"},
  {"published copies of the table differ on the stage of %1", "veröffentlichte Fassungen der Tabelle weichen beim Stadium von %1 voneinander ab", "les versions publiées du tableau diffèrent pour le stade de %1", "las versiones publicadas de la tabla difieren en el estadio de %1", "已发表的表格对 %1 的分期不一致"},
  {"an ankle pressure of 70 mmHg stands in two rows of the published table", "ein Knöcheldruck von 70 mmHg steht in zwei Zeilen der veröffentlichten Tabelle", "une pression de cheville de 70 mmHg figure dans deux lignes du tableau publié", "una presión de tobillo de 70 mmHg figura en dos filas de la tabla publicada", "踝压 70 mmHg 在已发表的表格中位于两行"},
};
// clang-format on

}  // namespace

std::optional<KnownSentence> sentenceNamed(const QString& english) {
  static const QRegularExpression kPlace(QStringLiteral("%[1-9]"));
  for (const Phrase& phrase : kSentences) {
    const std::string_view said = phrase.in(ReportLanguage::English);
    const QString pattern = QString::fromUtf8(said.data(), static_cast<int>(said.size()));
    if (!pattern.contains(kPlace)) {
      if (pattern == english) {
        return KnownSentence{&phrase, {}};
      }
      continue;
    }
    QString expression = QRegularExpression::escape(pattern);
    // "600 of 600" and nothing else that holds an "of", "0.65 mm" but no sentence that ends so.
    const QString slot = said.size() < 9 && said.starts_with('%') ? QStringLiteral("([0-9.]+)")
                                                                  : QStringLiteral("(.+)");
    expression.replace(QRegularExpression(QStringLiteral("\\\\%[1-9]")), slot);
    const QRegularExpression whole(QStringLiteral("^") + expression + QStringLiteral("$"));
    if (const auto match = whole.match(english); match.hasMatch()) {
      return KnownSentence{&phrase, match.capturedTexts().mid(1)};
    }
  }
  return std::nullopt;
}

}  // namespace tarsus::phrase
