<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE">
<context>
    <name>AccuracyView</name>
    <message>
        <source>Condition that is measured</source>
        <translation>Bedingung, die gemessen wird</translation>
    </message>
    <message>
        <source>Error that is shown</source>
        <translation>Gezeigter Fehler</translation>
    </message>
    <message>
        <source>Overlap</source>
        <translation>Überlappung</translation>
    </message>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>Cancelling …</source>
        <translation>Wird abgebrochen …</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Measure again</source>
        <translation>Neu messen</translation>
    </message>
    <message>
        <source>Measure</source>
        <translation>Messen</translation>
    </message>
    <message>
        <source>%1 % · %2</source>
        <translation>%1 % · %2</translation>
    </message>
    <message>
        <source>%1 % · another study is measured</source>
        <translation>%1 % · eine andere Studie wird gemessen</translation>
    </message>
    <message>
        <source>Choose a setting in the picture or the table, or with the arrow keys, to write it into the study.</source>
        <translation>Wählen Sie im Bild, in der Tabelle oder mit den Pfeiltasten eine Einstellung, um sie in die Studie zu schreiben.</translation>
    </message>
    <message>
        <source>Use</source>
        <translation>Übernehmen</translation>
    </message>
</context>
<context>
    <name>AttemptList</name>
    <message>
        <source>Attempts</source>
        <translation>Versuche</translation>
    </message>
    <message>
        <source>attempt %1</source>
        <translation>Versuch %1</translation>
    </message>
</context>
<context>
    <name>Console</name>
    <message>
        <source>What was done is kept. The participant goes on with the trial or questionnaire that was cut off; of a questionnaire only what was handed in is kept.</source>
        <translation>Was getan ist, bleibt. Es geht mit dem Durchgang oder Fragebogen weiter, der abgebrochen wurde; von einem Fragebogen bleibt nur, was abgegeben wurde.</translation>
    </message>
    <message>
        <source>Resume the session</source>
        <translation>Sitzung fortsetzen</translation>
    </message>
    <message>
        <source>Not now</source>
        <translation>Nicht jetzt</translation>
    </message>
    <message>
        <source>A session is running. Break it off and close?</source>
        <translation>Eine Sitzung läuft. Abbrechen und schließen?</translation>
    </message>
    <message>
        <source>What was done is kept, and the session can be resumed.</source>
        <translation>Was getan ist, bleibt, und die Sitzung kann fortgesetzt werden.</translation>
    </message>
    <message>
        <source>Break off and close</source>
        <translation>Abbrechen und schließen</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>Weitermachen</translation>
    </message>
    <message>
        <source>Studies</source>
        <translation>Studien</translation>
    </message>
    <message>
        <source>Session</source>
        <translation>Sitzung</translation>
    </message>
    <message>
        <source>loop at rest</source>
        <translation>Schleife ruht</translation>
    </message>
    <message>
        <source>Light</source>
        <translation>Hell</translation>
    </message>
    <message>
        <source>Dark</source>
        <translation>Dunkel</translation>
    </message>
    <message>
        <source>Participants</source>
        <translation>Versuchspersonen</translation>
    </message>
    <message>
        <source>Data</source>
        <translation>Daten</translation>
    </message>
    <message>
        <source>Participant&apos;s screen</source>
        <translation>Bildschirm der Versuchsperson</translation>
    </message>
    <message>
        <source>Participant: %1</source>
        <translation>Versuchsperson: %1</translation>
    </message>
</context>
<context>
    <name>DataPage</name>
    <message>
        <source>Which data</source>
        <translation>Welche Daten</translation>
    </message>
    <message>
        <source>Study</source>
        <translation>Studie</translation>
    </message>
    <message>
        <source>Try-outs</source>
        <translation>Proben</translation>
    </message>
    <message>
        <source>Other file</source>
        <translation>Andere Datei</translation>
    </message>
    <message>
        <source>Path of a database, then Enter</source>
        <translation>Pfad einer Datenbank, dann Eingabetaste</translation>
    </message>
    <message>
        <source>Reading …</source>
        <translation>Wird gelesen …</translation>
    </message>
    <message>
        <source>Nothing is recorded here yet.</source>
        <translation>Hier ist noch nichts aufgezeichnet.</translation>
    </message>
    <message>
        <source>SESSIONS</source>
        <translation>SITZUNGEN</translation>
    </message>
    <message>
        <source>ATTEMPTS</source>
        <translation>VERSUCHE</translation>
    </message>
    <message>
        <source>Replay the attempt</source>
        <translation>Versuch wiedergeben</translation>
    </message>
    <message>
        <source>Enter</source>
        <translation>Eingabe</translation>
    </message>
    <message>
        <source>Choose an attempt.</source>
        <translation>Wählen Sie einen Versuch.</translation>
    </message>
    <message>
        <source>QUICK LOOK</source>
        <translation>SCHNELLER BLICK</translation>
    </message>
    <message>
        <source>EXPORT</source>
        <translation>EXPORT</translation>
    </message>
</context>
<context>
    <name>DesignView</name>
    <message>
        <source>Reading …</source>
        <translation>Wird gelesen …</translation>
    </message>
    <message>
        <source>The study has problems.</source>
        <translation>Die Studie hat Fehler.</translation>
    </message>
    <message>
        <source>ORDERS</source>
        <translation>REIHENFOLGEN</translation>
    </message>
    <message>
        <source>Orders</source>
        <translation>Reihenfolgen</translation>
    </message>
    <message>
        <source>Blocks stand apart; ×n: the same pass n times; a frame marks catch trials.</source>
        <translation>Blöcke stehen getrennt; ×n: derselbe Durchlauf n-mal; ein Rahmen kennzeichnet Fangdurchgänge.</translation>
    </message>
    <message>
        <source>CONDITIONS</source>
        <translation>BEDINGUNGEN</translation>
    </message>
    <message>
        <source>Conditions</source>
        <translation>Bedingungen</translation>
    </message>
    <message>
        <source>BLOCKS</source>
        <translation>BLÖCKE</translation>
    </message>
</context>
<context>
    <name>Enrolment</name>
    <message>
        <source>Kind</source>
        <translation>Art</translation>
    </message>
    <message>
        <source>Person</source>
        <translation>Person</translation>
    </message>
    <message>
        <source>Pilot</source>
        <translation>Pilot</translation>
    </message>
    <message>
        <source>Code</source>
        <translation>Code</translation>
    </message>
    <message>
        <source>Enrol</source>
        <translation>Aufnehmen</translation>
    </message>
    <message>
        <source>Reading …</source>
        <translation>Wird gelesen …</translation>
    </message>
</context>
<context>
    <name>ExportView</name>
    <message>
        <source>Folder</source>
        <translation>Ordner</translation>
    </message>
    <message>
        <source>with every tick</source>
        <translation>mit jedem Takt</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>Exportieren</translation>
    </message>
    <message>
        <source>Export: %1 %</source>
        <translation>Export: %1 %</translation>
    </message>
    <message>
        <source>%1 %</source>
        <translation>%1 %</translation>
    </message>
    <message>
        <source>CSV tables with a codebook; a report adds the planned analyses, computed by R. An earlier export in the folder is replaced, a folder with other files is refused.</source>
        <translation>CSV-Tabellen mit Codebuch; ein Bericht fügt die geplanten Analysen hinzu, von R berechnet. Ein früherer Export im Ordner wird ersetzt, ein Ordner mit anderen Dateien abgelehnt.</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Bericht</translation>
    </message>
    <message>
        <source>R computes the planned analyses …</source>
        <translation>R berechnet die geplanten Analysen …</translation>
    </message>
    <message>
        <source>Open the report</source>
        <translation>Bericht öffnen</translation>
    </message>
    <message>
        <source>R would take time from the running session.</source>
        <translation>R nähme der laufenden Sitzung Zeit weg.</translation>
    </message>
    <message>
        <source>Open the folder</source>
        <translation>Ordner öffnen</translation>
    </message>
</context>
<context>
    <name>FrontPlot</name>
    <message>
        <source>%1 over the processor time of a tick, of every measured setting</source>
        <translation>%1 über der Prozessorzeit eines Takts, von jeder gemessenen Einstellung</translation>
    </message>
    <message>
        <source>processor time of a tick, 99.9 % below [µs]</source>
        <translation>Prozessorzeit eines Takts, 99,9 % darunter [µs]</translation>
    </message>
</context>
<context>
    <name>FrontView</name>
    <message>
        <source>true overlap [µm]</source>
        <translation>wahre Überlappung [µm]</translation>
    </message>
    <message>
        <source>error of the force [%]</source>
        <translation>Fehler der Kraft [%]</translation>
    </message>
    <message>
        <source>Line: no setting is both faster and nearer the truth. Ring: the study&apos;s own. Bars: from the median; of the overlap from what was found to what is proven.</source>
        <translation>Linie: Keine Einstellung ist zugleich schneller und näher an der Wahrheit. Ring: die der Studie. Balken: vom Median an; bei der Überlappung vom Gefundenen bis zum Bewiesenen.</translation>
    </message>
    <message>
        <source>SETTING</source>
        <translation>EINSTELLUNG</translation>
    </message>
    <message>
        <source>Measured settings, the fastest first</source>
        <translation>Gemessene Einstellungen, die schnellste zuerst</translation>
    </message>
    <message>
        <source>%1: %2 µs, %3</source>
        <translation>%1: %2 µs, %3</translation>
    </message>
    <message>
        <source>in the study</source>
        <translation>in der Studie</translation>
    </message>
</context>
<context>
    <name>LeavingView</name>
    <message>
        <source>In the backup as well</source>
        <translation>Auch in der Sicherung</translation>
    </message>
    <message>
        <source>How does the part of %1 end?</source>
        <translation>Wie endet die Teilnahme von %1?</translation>
    </message>
    <message>
        <source>AT THEIR WISH</source>
        <translation>AUF EIGENEN WUNSCH</translation>
    </message>
    <message>
        <source>Take part no more</source>
        <translation>Keine weitere Teilnahme</translation>
    </message>
    <message>
        <source>What is there stays and counts in the analysis.</source>
        <translation>Was da ist, bleibt und zählt in der Auswertung.</translation>
    </message>
    <message>
        <source>Data is not to be used</source>
        <translation>Daten sollen nicht verwendet werden</translation>
    </message>
    <message>
        <source>What is there stays and counts nowhere.</source>
        <translation>Was da ist, bleibt und zählt nirgends.</translation>
    </message>
    <message>
        <source>Erase everything</source>
        <translation>Alles löschen</translation>
    </message>
    <message>
        <source>No byte of this participant remains in the database.</source>
        <translation>Kein Byte dieser Person bleibt in der Datenbank.</translation>
    </message>
    <message>
        <source>AT THE EXPERIMENTER&apos;S DECISION</source>
        <translation>ENTSCHEIDUNG DER VERSUCHSLEITUNG</translation>
    </message>
    <message>
        <source>Exclude</source>
        <translation>Ausschließen</translation>
    </message>
    <message>
        <source>What is there stays and counts nowhere; this can be taken back.</source>
        <translation>Was da ist, bleibt und zählt nirgends; das lässt sich zurücknehmen.</translation>
    </message>
    <message>
        <source>Reason, without names</source>
        <translation>Grund, ohne Namen</translation>
    </message>
    <message>
        <source>Erase %1?</source>
        <translation>%1 löschen?</translation>
    </message>
    <message>
        <source>%1 leaves the study?</source>
        <translation>%1 verlässt die Studie?</translation>
    </message>
    <message>
        <source>Type %1 to confirm</source>
        <translation>Zum Bestätigen %1 eintippen</translation>
    </message>
    <message>
        <source>Continue …</source>
        <translation>Weiter …</translation>
    </message>
    <message>
        <source>Erase for good</source>
        <translation>Endgültig löschen</translation>
    </message>
    <message>
        <source>Yes, end their part</source>
        <translation>Ja, Teilnahme beenden</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>Zurück</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
</context>
<context>
    <name>LookView</name>
    <message>
        <source>Measure</source>
        <translation>Maß</translation>
    </message>
    <message>
        <source>Kind of participants</source>
        <translation>Art der Versuchspersonen</translation>
    </message>
    <message>
        <source>median (quartiles), n</source>
        <translation>Median (Quartile), n</translation>
    </message>
    <message>
        <source>Trials: %1, participants: %2</source>
        <translation>Durchgänge: %1, Personen: %2</translation>
    </message>
</context>
<context>
    <name>Participant</name>
    <message>
        <source>Passung – participant</source>
        <translation>Passung – Versuchsperson</translation>
    </message>
</context>
<context>
    <name>ParticipantList</name>
    <message>
        <source>Code</source>
        <translation>Code</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>Art</translation>
    </message>
    <message>
        <source>Sessions</source>
        <translation>Sitzungen</translation>
    </message>
    <message>
        <source>Consent</source>
        <translation>Einwilligung</translation>
    </message>
    <message>
        <source>Place</source>
        <translation>Platz</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Stand</translation>
    </message>
    <message>
        <source>Participants</source>
        <translation>Versuchspersonen</translation>
    </message>
    <message>
        <source>%1 of %2 sessions</source>
        <translation>%1 von %2 Sitzungen</translation>
    </message>
    <message>
        <source>%1 of %2</source>
        <translation>%1 von %2</translation>
    </message>
    <message>
        <source>%1 broken off</source>
        <translation>%1 abgebrochen</translation>
    </message>
    <message>
        <source>Nobody is enrolled yet.</source>
        <translation>Noch ist niemand aufgenommen.</translation>
    </message>
</context>
<context>
    <name>ParticipantsPage</name>
    <message>
        <source>Experimenter</source>
        <translation>Versuchsleitung</translation>
    </message>
    <message>
        <source>Initials</source>
        <translation>Kürzel</translation>
    </message>
    <message>
        <source>Experimenter (initials)</source>
        <translation>Versuchsleitung (Kürzel)</translation>
    </message>
    <message>
        <source>PARTICIPANTS</source>
        <translation>VERSUCHSPERSONEN</translation>
    </message>
    <message>
        <source>PLACES IN THE DESIGN</source>
        <translation>PLÄTZE IM VERSUCHSPLAN</translation>
    </message>
    <message>
        <source>%1 of %2 taken</source>
        <translation>%1 von %2 vergeben</translation>
    </message>
</context>
<context>
    <name>PersonView</name>
    <message>
        <source>Choose a participant to see sessions and consent.</source>
        <translation>Wählen Sie jemanden aus, um Sitzungen und Einwilligung zu sehen.</translation>
    </message>
    <message>
        <source>enrolled %1</source>
        <translation>aufgenommen %1</translation>
    </message>
    <message>
        <source>SESSIONS</source>
        <translation>SITZUNGEN</translation>
    </message>
    <message>
        <source>Session %1</source>
        <translation>Sitzung %1</translation>
    </message>
    <message>
        <source>valid attempts of planned trials: %1</source>
        <translation>gültige Versuche von geplanten Durchgängen: %1</translation>
    </message>
    <message>
        <source>none yet</source>
        <translation>noch keine</translation>
    </message>
    <message>
        <source>CONSENT</source>
        <translation>EINWILLIGUNG</translation>
    </message>
    <message>
        <source>Agreed</source>
        <translation>Zugestimmt</translation>
    </message>
    <message>
        <source>Declined</source>
        <translation>Abgelehnt</translation>
    </message>
    <message>
        <source>Withdrawn</source>
        <translation>Zurückgezogen</translation>
    </message>
    <message>
        <source>A session is running.</source>
        <translation>Eine Sitzung läuft.</translation>
    </message>
    <message>
        <source>Reading …</source>
        <translation>Wird gelesen …</translation>
    </message>
    <message>
        <source>Record here what was signed on paper; who has not been asked is asked when the session begins.</source>
        <translation>Tragen Sie hier ein, was auf Papier unterschrieben wurde; wer noch nicht gefragt wurde, wird zu Beginn der Sitzung gefragt.</translation>
    </message>
    <message>
        <source>TAKE BACK THE EXCLUSION</source>
        <translation>AUSSCHLUSS ZURÜCKNEHMEN</translation>
    </message>
    <message>
        <source>Reason</source>
        <translation>Grund</translation>
    </message>
    <message>
        <source>Readmit</source>
        <translation>Wieder aufnehmen</translation>
    </message>
    <message>
        <source>Resume the session</source>
        <translation>Sitzung fortsetzen</translation>
    </message>
    <message>
        <source>Start a new session instead</source>
        <translation>Stattdessen neue Sitzung beginnen</translation>
    </message>
    <message>
        <source>Start the session</source>
        <translation>Sitzung beginnen</translation>
    </message>
    <message>
        <source>End their part …</source>
        <translation>Teilnahme beenden …</translation>
    </message>
</context>
<context>
    <name>PickView</name>
    <message>
        <source>Error over time of every measured setting</source>
        <translation>Fehler über der Zeit jeder gemessenen Einstellung</translation>
    </message>
    <message>
        <source>time of a query, 99 % below [µs]</source>
        <translation>Zeit einer Abfrage, 99 % darunter [µs]</translation>
    </message>
    <message>
        <source>error of the depth, 99 % below [µm]</source>
        <translation>Fehler der Tiefe, 99 % darunter [µm]</translation>
    </message>
    <message>
        <source>Large dots: none is both faster and more exact. Ring: picked for this study. Stroke: the budget.</source>
        <translation>Große Punkte: Keine Einstellung ist zugleich schneller und genauer. Ring: für diese Studie gewählt. Strich: das Budget.</translation>
    </message>
</context>
<context>
    <name>PlacesView</name>
    <message>
        <source>Place %1: %2</source>
        <translation>Platz %1: %2</translation>
    </message>
    <message>
        <source>free</source>
        <translation>frei</translation>
    </message>
</context>
<context>
    <name>ReplayView</name>
    <message>
        <source>Reading …</source>
        <translation>Wird gelesen …</translation>
    </message>
    <message>
        <source>Solid: the proxy, as it was drawn. Pale: the hand. Arrow: the force on the hand.</source>
        <translation>Voll: der Proxy, wie er gezeichnet wurde. Blass: die Hand. Pfeil: die Kraft auf die Hand.</translation>
    </message>
    <message>
        <source>Solid: the hand, as it was drawn. Pale: the proxy. Arrow: the force on the hand.</source>
        <translation>Voll: die Hand, wie sie gezeichnet wurde. Blass: der Proxy. Pfeil: die Kraft auf die Hand.</translation>
    </message>
    <message>
        <source>THE WHOLE ATTEMPT</source>
        <translation>DER GANZE VERSUCH</translation>
    </message>
    <message>
        <source>Force on the hand</source>
        <translation>Kraft auf die Hand</translation>
    </message>
    <message>
        <source>Depth of the hand in the material</source>
        <translation>Tiefe der Hand im Material</translation>
    </message>
    <message>
        <source>Overlap of the proxy</source>
        <translation>Überlappung des Proxys</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Pause</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>Abspielen</translation>
    </message>
    <message>
        <source>Space</source>
        <translation>Leertaste</translation>
    </message>
    <message>
        <source>Time in the attempt</source>
        <translation>Zeit im Versuch</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Tempo</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
</context>
<context>
    <name>RunCommands</name>
    <message>
        <source>Repeat</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>Ctrl+R</source>
        <translation>Strg+R</translation>
    </message>
    <message>
        <source>Leave out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Ctrl+K</source>
        <translation>Strg+K</translation>
    </message>
    <message>
        <source>Succeeded</source>
        <translation>Gelungen</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>Misslungen</translation>
    </message>
    <message>
        <source>Note or reason</source>
        <translation>Notiz oder Grund</translation>
    </message>
    <message>
        <source>Keep note</source>
        <translation>Notieren</translation>
    </message>
    <message>
        <source>Write it first.</source>
        <translation>Erst die Notiz schreiben.</translation>
    </message>
    <message>
        <source>Does not count</source>
        <translation>Zählt nicht</translation>
    </message>
    <message>
        <source>Write the reason first.</source>
        <translation>Erst den Grund schreiben.</translation>
    </message>
    <message>
        <source>Really end the session?</source>
        <translation>Sitzung wirklich beenden?</translation>
    </message>
    <message>
        <source>End the session</source>
        <translation>Sitzung beenden</translation>
    </message>
</context>
<context>
    <name>RunPage</name>
    <message>
        <source>TRIALS</source>
        <translation>DURCHGÄNGE</translation>
    </message>
    <message>
        <source>PARTICIPANT&apos;S VIEW</source>
        <translation>SICHT DER VERSUCHSPERSON</translation>
    </message>
    <message>
        <source>LAST TEN SECONDS</source>
        <translation>DIE LETZTEN ZEHN SEKUNDEN</translation>
    </message>
    <message>
        <source>Force on the hand</source>
        <translation>Kraft auf die Hand</translation>
    </message>
    <message>
        <source>Depth of the hand in the material</source>
        <translation>Tiefe der Hand im Material</translation>
    </message>
    <message>
        <source>SESSION</source>
        <translation>SITZUNG</translation>
    </message>
    <message>
        <source>HAPTIC LOOP</source>
        <translation>HAPTISCHE SCHLEIFE</translation>
    </message>
    <message>
        <source>STEPS</source>
        <translation>SCHRITTE</translation>
    </message>
    <message>
        <source>%1 of %2</source>
        <translation>%1 von %2</translation>
    </message>
    <message>
        <source>Rate</source>
        <translation>Takt</translation>
    </message>
    <message>
        <source>Missed cycles</source>
        <translation>Versäumte Takte</translation>
    </message>
    <message>
        <source>Tick, typical</source>
        <translation>Rechenzeit, üblich</translation>
    </message>
    <message>
        <source>Tick, longest</source>
        <translation>Rechenzeit, längste</translation>
    </message>
    <message>
        <source>Emergency stop</source>
        <translation>Not-Halt</translation>
    </message>
    <message>
        <source>Esc</source>
        <translation>Esc</translation>
    </message>
    <message>
        <source>No scene is shown now.</source>
        <translation>Zurzeit wird keine Szene gezeigt.</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Beginnen</translation>
    </message>
    <message>
        <source>Continue</source>
        <translation>Fortsetzen</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Pause</translation>
    </message>
    <message>
        <source>Ctrl+P</source>
        <translation>Strg+P</translation>
    </message>
    <message>
        <source>No X server: an emergency stop waits while this window draws.</source>
        <translation>Kein X-Server: Ein Not-Halt wartet, solange dieses Fenster zeichnet.</translation>
    </message>
    <message>
        <source>Pictures</source>
        <translation>Bilder</translation>
    </message>
    <message>
        <source>Picture&apos;s age</source>
        <translation>Alter des Bildes</translation>
    </message>
</context>
<context>
    <name>SessionList</name>
    <message>
        <source>Sessions</source>
        <translation>Sitzungen</translation>
    </message>
    <message>
        <source>Session %1</source>
        <translation>Sitzung %1</translation>
    </message>
</context>
<context>
    <name>SourceView</name>
    <message>
        <source>The place is in the clipboard. “Read again” checks the file once you have changed it.</source>
        <translation>Die Stelle ist in der Zwischenablage. „Neu lesen“ prüft die Datei, wenn Sie sie geändert haben.</translation>
    </message>
    <message>
        <source>Text of the protocol</source>
        <translation>Text des Protokolls</translation>
    </message>
</context>
<context>
    <name>StageTable</name>
    <message>
        <source>%1 µs a tick</source>
        <translation>%1 µs je Takt</translation>
    </message>
    <message>
        <source>%1: %2 µs, 99 % below %3 µs; %4</source>
        <translation>%1: %2 µs, 99 % unter %3 µs; %4</translation>
    </message>
</context>
<context>
    <name>StateLine</name>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Open the participant&apos;s window</source>
        <translation>Fenster der Versuchsperson öffnen</translation>
    </message>
</context>
<context>
    <name>StudiesPage</name>
    <message>
        <source>STUDIES</source>
        <translation>STUDIEN</translation>
    </message>
    <message>
        <source>Conditions: %1 · trials: %2 · participants: %3</source>
        <translation>Bedingungen: %1 · Durchgänge: %2 · Personen: %3</translation>
    </message>
    <message>
        <source>%1, version %2 · %3</source>
        <translation>%1, Fassung %2 · %3</translation>
    </message>
    <message>
        <source>Try it with the mouse</source>
        <translation>Mit der Maus ausprobieren</translation>
    </message>
    <message>
        <source>The study has problems.</source>
        <translation>Die Studie hat Mängel.</translation>
    </message>
    <message>
        <source>The study has a cue that nothing here can give to a person: watch a simulated participant.</source>
        <translation>Die Studie hat einen Hinweisreiz, den hier nichts einem Menschen geben kann: Sehen Sie einer simulierten Person zu.</translation>
    </message>
    <message>
        <source>A session is running.</source>
        <translation>Es läuft eine Sitzung.</translation>
    </message>
    <message>
        <source>Watch a simulated participant</source>
        <translation>Simulierter Person zusehen</translation>
    </message>
    <message>
        <source>Both show the trials only: consent, instructions and questionnaires are left out.</source>
        <translation>Beides zeigt nur die Durchgänge: Einwilligung, Anleitung und Fragebögen entfallen.</translation>
    </message>
    <message>
        <source>Problems: %1</source>
        <translation>Mängel: %1</translation>
    </message>
    <message>
        <source>Read again</source>
        <translation>Neu lesen</translation>
    </message>
    <message>
        <source>Ctrl+L</source>
        <translation>Strg+L</translation>
    </message>
    <message>
        <source>Part of the study</source>
        <translation>Teil der Studie</translation>
    </message>
    <message>
        <source>Overview</source>
        <translation>Überblick</translation>
    </message>
    <message>
        <source>Design</source>
        <translation>Versuchsplan</translation>
    </message>
    <message>
        <source>Tick and stiffness</source>
        <translation>Takt und Steifigkeit</translation>
    </message>
    <message>
        <source>Accuracy</source>
        <translation>Genauigkeit</translation>
    </message>
    <message>
        <source>Protocol</source>
        <translation>Protokoll</translation>
    </message>
</context>
<context>
    <name>StudyBar</name>
    <message>
        <source>Study</source>
        <translation>Studie</translation>
    </message>
</context>
<context>
    <name>StudyOverview</name>
    <message>
        <source>Conditions</source>
        <translation>Bedingungen</translation>
    </message>
    <message>
        <source>Trials</source>
        <translation>Durchgänge</translation>
    </message>
    <message>
        <source>in the first of %1 sessions</source>
        <translation>in der ersten von %1 Sitzungen</translation>
    </message>
    <message>
        <source>About</source>
        <translation>Etwa</translation>
    </message>
    <message>
        <source>min</source>
        <translation>min</translation>
    </message>
    <message>
        <source>Participants</source>
        <translation>Versuchspersonen</translation>
    </message>
    <message>
        <source>CHECKS</source>
        <translation>PRÜFUNGEN</translation>
    </message>
    <message>
        <source>The protocol is sound.</source>
        <translation>Das Protokoll ist in Ordnung.</translation>
    </message>
    <message>
        <source>The loop runs for ten seconds …</source>
        <translation>Die Schleife läuft zehn Sekunden …</translation>
    </message>
    <message>
        <source>Loop on this machine: %1</source>
        <translation>Schleife auf diesem Rechner: %1</translation>
    </message>
    <message>
        <source>Whether this machine keeps 1 kHz has not been checked.</source>
        <translation>Ob dieser Rechner 1 kHz hält, ist noch nicht geprüft.</translation>
    </message>
    <message>
        <source>Check the loop</source>
        <translation>Schleife prüfen</translation>
    </message>
    <message>
        <source>Cycle late by, median</source>
        <translation>Zyklus verspätet um, Median</translation>
    </message>
    <message>
        <source>worst</source>
        <translation>schlechtester</translation>
    </message>
    <message>
        <source>Cycles missed</source>
        <translation>Verpasste Zyklen</translation>
    </message>
    <message>
        <source>of %1</source>
        <translation>von %1</translation>
    </message>
    <message>
        <source>WHAT IS VARIED</source>
        <translation>WAS VARIIERT WIRD</translation>
    </message>
    <message>
        <source>WHAT IS ASKED</source>
        <translation>WAS GEFRAGT WIRD</translation>
    </message>
</context>
<context>
    <name>TickView</name>
    <message>
        <source>STIFFNESS AGAINST THE DEVICE&apos;S BORDER</source>
        <translation>STEIFIGKEIT GEGEN DIE GRENZE DES GERÄTS</translation>
    </message>
    <message>
        <source>A bar ends at the stiffness that the hand feels; the thin stroke is the device&apos;s “max”, the right edge its border of stability by the model of its mechanism.</source>
        <translation>Ein Balken endet bei der Steifigkeit, die die Hand spürt; der dünne Strich ist das „max“ des Geräts, der rechte Rand seine Stabilitätsgrenze nach dem Modell seiner Mechanik.</translation>
    </message>
    <message>
        <source>No condition displays a force.</source>
        <translation>Keine Bedingung zeigt eine Kraft.</translation>
    </message>
    <message>
        <source>STAGES OF THE TICK, IN SLIDING CONTACT ON THIS MACHINE</source>
        <translation>STUFEN DES TAKTS, BEI GLEITENDEM KONTAKT AUF DIESEM RECHNER</translation>
    </message>
    <message>
        <source>Measuring …</source>
        <translation>Wird gemessen …</translation>
    </message>
    <message>
        <source>Measure again</source>
        <translation>Neu messen</translation>
    </message>
    <message>
        <source>Measure here</source>
        <translation>Hier messen</translation>
    </message>
    <message>
        <source>Only what a scene names is built and called. Measuring builds each scene, presses its held part two millimetres into the nearest obstacle and takes the time of every stage over 2000 ticks.</source>
        <translation>Nur was eine Szene nennt, wird gebaut und aufgerufen. Die Messung baut jede Szene, drückt das gehaltene Teil zwei Millimeter in das nächste Hindernis und misst die Zeit jeder Stufe über 2000 Takte.</translation>
    </message>
</context>
<context>
    <name>TraceView</name>
    <message>
        <source>now</source>
        <translation>jetzt</translation>
    </message>
</context>
<context>
    <name>TrialList</name>
    <message>
        <source>Trials</source>
        <translation>Durchgänge</translation>
    </message>
    <message>
        <source>Attempts: %1</source>
        <translation>Versuche: %1</translation>
    </message>
</context>
<context>
    <name>WallRow</name>
    <message>
        <source> of %1</source>
        <translation> von %1</translation>
    </message>
    <message>
        <source>what the device bears is not known</source>
        <translation>was das Gerät trägt, ist nicht bekannt</translation>
    </message>
    <message>
        <source>stable: %1 % of the border</source>
        <translation>stabil: %1 % der Grenze</translation>
    </message>
    <message>
        <source>✕ unstable by the model</source>
        <translation>✕ instabil nach dem Modell</translation>
    </message>
</context>
<context>
    <name>accuracy</name>
    <message>
        <source>%1 µm</source>
        <translation>%1 µm</translation>
    </message>
    <message>
        <source>points %1 mm apart</source>
        <translation>Punkte alle %1 mm</translation>
    </message>
    <message>
        <source>both ways</source>
        <translation>beidseitig</translation>
    </message>
    <message>
        <source>%1 nodes</source>
        <translation>%1 Knoten</translation>
    </message>
    <message>
        <source>median %1 µs, 99.9 % of ticks below %2 µs, most %3 µs</source>
        <translation>Median %1 µs, 99,9 % der Takte unter %2 µs, höchstens %3 µs</translation>
    </message>
    <message>
        <source>true overlap at most %1 µm</source>
        <translation>wahre Überlappung höchstens %1 µm</translation>
    </message>
    <message>
        <source>force wrong by %1 % (99 % of ticks below)</source>
        <translation>Kraft um %1 % falsch (99 % der Takte darunter)</translation>
    </message>
    <message>
        <source>the hand&apos;s path</source>
        <translation>der Weg der Hand</translation>
    </message>
    <message>
        <source>Measured on another machine (%1) by passung %2 on %3.</source>
        <translation>Auf einem anderen Rechner gemessen (%1), mit passung %2 am %3.</translation>
    </message>
    <message>
        <source>Measured before on this machine (%1) by passung %2 on %3.</source>
        <translation>Früher auf diesem Rechner gemessen (%1), mit passung %2 am %3.</translation>
    </message>
    <message>
        <source>The study has changed since: measure again to be sure.</source>
        <translation>Die Studie wurde seither geändert: Eine neue Messung schafft Sicherheit.</translation>
    </message>
    <message>
        <source>about %1 s left</source>
        <translation>noch etwa %1 s</translation>
    </message>
    <message>
        <source>about %1 min left</source>
        <translation>noch etwa %1 min</translation>
    </message>
    <message>
        <source>Measured along a simulated hand&apos;s way in a trial, %1 s.</source>
        <translation>Gemessen auf dem Weg einer simulierten Hand in einem Durchgang, %1 s.</translation>
    </message>
    <message>
        <source>Measured while the held part is pressed 2 mm into the nearest obstacle and slides, %1 s.</source>
        <translation>Gemessen, während das gehaltene Teil 2 mm in das nächste Hindernis gedrückt wird und gleitet, %1 s.</translation>
    </message>
    <message>
        <source>The scene has no obstacle: nothing can overlap.</source>
        <translation>Die Szene hat kein Hindernis: Nichts kann sich überlappen.</translation>
    </message>
    <message>
        <source>No force to compare with: it is known for a ball among solids without hollows, and for a round peg in a bore.</source>
        <translation>Keine Kraft zum Vergleichen: Bekannt ist sie für eine Kugel zwischen Körpern ohne Höhlungen und für einen runden Stift in einer Bohrung.</translation>
    </message>
    <message>
        <source>Written into the study&apos;s file.</source>
        <translation>In die Datei der Studie geschrieben.</translation>
    </message>
    <message>
        <source>The study says so already: nothing was written.</source>
        <translation>Die Studie sagt das schon: Nichts wurde geschrieben.</translation>
    </message>
    <message>
        <source>Nothing was written: the file has changed since it was measured. Read it again and measure.</source>
        <translation>Nichts wurde geschrieben: Die Datei hat sich seit der Messung geändert. Lesen Sie sie neu und messen Sie.</translation>
    </message>
    <message>
        <source>Nothing was written: the study has begun, its database holds what it runs by.</source>
        <translation>Nichts wurde geschrieben: Die Studie hat begonnen, ihre Datenbank hält fest, wonach sie läuft.</translation>
    </message>
    <message>
        <source>Nothing was written: %1 is set at %2, by a factor, a block or a staircase.</source>
        <translation>Nichts wurde geschrieben: %1 wird bei %2 gesetzt, von einem Faktor, einem Block oder einem Staircase-Verfahren.</translation>
    </message>
    <message>
        <source>Nothing was written: %1</source>
        <translation>Nichts wurde geschrieben: %1</translation>
    </message>
    <message>
        <source>Choose a setting first.</source>
        <translation>Wählen Sie zuerst eine Einstellung.</translation>
    </message>
    <message>
        <source>Writing …</source>
        <translation>Wird geschrieben …</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>tolerance %1 µm</source>
        <translation>Toleranz %1 µm</translation>
    </message>
    <message>
        <source>cell %1 mm</source>
        <translation>Zelle %1 mm</translation>
    </message>
    <message>
        <source>cells of %1 mm</source>
        <translation>Zellen von %1 mm</translation>
    </message>
    <message>
        <source>%1 MB</source>
        <translation>%1 MB</translation>
    </message>
    <message>
        <source>%1 of %2 ticks end in the next one</source>
        <translation>%1 von %2 Takten enden erst im nächsten</translation>
    </message>
    <message>
        <source>The trials of this condition are done with real parts: choose another one.</source>
        <translation>Die Durchgänge dieser Bedingung werden mit echten Teilen gemacht: Wählen Sie eine andere.</translation>
    </message>
    <message>
        <source>Measuring was given up, since a session began.</source>
        <translation>Die Messung wurde aufgegeben, weil eine Sitzung begann.</translation>
    </message>
</context>
<context>
    <name>data</name>
    <message>
        <source>crashed</source>
        <translation>abgestürzt</translation>
    </message>
    <message>
        <source>%1 · session %2 · trial %3, attempt %4 · %5</source>
        <translation>%1 · Sitzung %2 · Durchgang %3, Versuch %4 · %5</translation>
    </message>
    <message>
        <source>%1: %2 attempts in %3 files</source>
        <translation>%1: %2 Versuche in %3 Dateien</translation>
    </message>
    <message>
        <source>%1: %2 attempts in %3 files; damaged and left out: %4, see missing.csv</source>
        <translation>%1: %2 Versuche in %3 Dateien; beschädigt und ausgelassen: %4, siehe missing.csv</translation>
    </message>
    <message>
        <source>The earlier export may hold what is damaged now: kept as %1</source>
        <translation>Der frühere Export hat vielleicht, was jetzt beschädigt ist: aufbewahrt als %1</translation>
    </message>
    <message>
        <source>Damaged and left out here: %1; passung verify names each</source>
        <translation>Beschädigt und hier ausgelassen: %1; passung verify nennt jedes</translation>
    </message>
    <message>
        <source>The report&apos;s page needs what is not installed: %1</source>
        <translation>Die Seite des Berichts braucht, was nicht installiert ist: %1</translation>
    </message>
    <message>
        <source>R made no report of analysis.Rmd: %1</source>
        <translation>R machte keinen Bericht aus analysis.Rmd: %1</translation>
    </message>
    <message>
        <source>The export was cancelled; nothing was written.</source>
        <translation>Der Export wurde abgebrochen; nichts wurde geschrieben.</translation>
    </message>
</context>
<context>
    <name>devices</name>
    <message>
        <source>Force Dimension sigma.7 (simulated)</source>
        <translation>Force Dimension sigma.7 (simuliert)</translation>
    </message>
    <message>
        <source>DLR HUG, one arm (simulated)</source>
        <translation>DLR HUG, ein Arm (simuliert)</translation>
    </message>
    <message>
        <source>Haption Virtuose 6D35-45 (simulated)</source>
        <translation>Haption Virtuose 6D35-45 (simuliert)</translation>
    </message>
    <message>
        <source>Novint Falcon (simulated)</source>
        <translation>Novint Falcon (simuliert)</translation>
    </message>
    <message>
        <source>Wearable haptic interface, TU Berlin and DLR (simulated)</source>
        <translation>Tragbares haptisches Gerät, TU Berlin und DLR (simuliert)</translation>
    </message>
    <message>
        <source>3D Systems Touch, formerly Phantom Omni (simulated)</source>
        <translation>3D Systems Touch, früher Phantom Omni (simuliert)</translation>
    </message>
    <message>
        <source>Haply Inverse3 with a grip (simulated)</source>
        <translation>Haply Inverse3 mit Griff (simuliert)</translation>
    </message>
    <message>
        <source>3Dconnexion SpaceMouse (simulated)</source>
        <translation>3Dconnexion SpaceMouse (simuliert)</translation>
    </message>
    <message>
        <source>Tracker of six degrees without motors (simulated)</source>
        <translation>Tracker mit sechs Freiheitsgraden ohne Motoren (simuliert)</translation>
    </message>
    <message>
        <source>Any device (simulated)</source>
        <translation>Beliebiges Gerät (simuliert)</translation>
    </message>
</context>
<context>
    <name>measures</name>
    <message>
        <source>Success</source>
        <translation>Gelungen</translation>
    </message>
    <message>
        <source>Completion time</source>
        <translation>Dauer ab der ersten Bewegung</translation>
    </message>
    <message>
        <source>Trial time</source>
        <translation>Dauer des Durchgangs</translation>
    </message>
    <message>
        <source>Time to success, or to the end without one</source>
        <translation>Zeit bis zum Gelingen, sonst bis zum Ende</translation>
    </message>
    <message>
        <source>Whether the time ended in success</source>
        <translation>Ob die Zeit mit dem Gelingen endete</translation>
    </message>
    <message>
        <source>Approach time</source>
        <translation>Dauer der Annäherung</translation>
    </message>
    <message>
        <source>Search time</source>
        <translation>Suchdauer</translation>
    </message>
    <message>
        <source>Insertion time</source>
        <translation>Dauer des Einführens</translation>
    </message>
    <message>
        <source>Insertion depth</source>
        <translation>Einführtiefe</translation>
    </message>
    <message>
        <source>Path length of the hand</source>
        <translation>Weg der Hand</translation>
    </message>
    <message>
        <source>Path length over the straight distance</source>
        <translation>Weg der Hand durch die gerade Strecke</translation>
    </message>
    <message>
        <source>Rotation path of the hand</source>
        <translation>Drehweg der Hand</translation>
    </message>
    <message>
        <source>Smoothness: spectral arc length (SPARC)</source>
        <translation>Glätte: spektrale Bogenlänge (SPARC)</translation>
    </message>
    <message>
        <source>Smoothness: log dimensionless jerk</source>
        <translation>Glätte: Logarithmus des dimensionslosen Rucks</translation>
    </message>
    <message>
        <source>Contact onsets</source>
        <translation>Beginne von Kontakt</translation>
    </message>
    <message>
        <source>Contact time</source>
        <translation>Dauer des Kontakts</translation>
    </message>
    <message>
        <source>Contact time outside the hole</source>
        <translation>Dauer des Kontakts außerhalb des Lochs</translation>
    </message>
    <message>
        <source>Mean force</source>
        <translation>Mittlere Kraft</translation>
    </message>
    <message>
        <source>Peak force</source>
        <translation>Größte Kraft</translation>
    </message>
    <message>
        <source>Force, 99th percentile</source>
        <translation>Kraft, 99. Perzentil</translation>
    </message>
    <message>
        <source>Mean torque</source>
        <translation>Mittleres Drehmoment</translation>
    </message>
    <message>
        <source>Peak torque</source>
        <translation>Größtes Drehmoment</translation>
    </message>
    <message>
        <source>Torque, 99th percentile</source>
        <translation>Drehmoment, 99. Perzentil</translation>
    </message>
    <message>
        <source>Mean depth at the hand&apos;s pose</source>
        <translation>Mittlere Tiefe der Hand</translation>
    </message>
    <message>
        <source>Largest depth at the hand&apos;s pose</source>
        <translation>Größte Tiefe der Hand</translation>
    </message>
    <message>
        <source>Depth at the hand&apos;s pose, 99th percentile</source>
        <translation>Tiefe der Hand, 99. Perzentil</translation>
    </message>
    <message>
        <source>Mean depth at the proxy&apos;s pose</source>
        <translation>Mittlere Tiefe des Proxys</translation>
    </message>
    <message>
        <source>Largest depth at the proxy&apos;s pose</source>
        <translation>Größte Tiefe des Proxys</translation>
    </message>
    <message>
        <source>Depth at the proxy&apos;s pose, 99th percentile</source>
        <translation>Tiefe des Proxys, 99. Perzentil</translation>
    </message>
    <message>
        <source>Least proven gap at the proxy&apos;s pose</source>
        <translation>Kleinster bewiesener Spalt am Proxy</translation>
    </message>
    <message>
        <source>Largest true overlap of what was shown</source>
        <translation>Größte wahre Überlappung des Gezeigten</translation>
    </message>
    <message>
        <source>Share of contact ticks with a true overlap</source>
        <translation>Anteil der Kontakttakte mit wahrer Überlappung</translation>
    </message>
    <message>
        <source>Impulse</source>
        <translation>Impuls</translation>
    </message>
    <message>
        <source>Work of the hand</source>
        <translation>Arbeit der Hand</translation>
    </message>
    <message>
        <source>Share of ticks at the force limit</source>
        <translation>Anteil der Takte an der Kraftgrenze</translation>
    </message>
    <message>
        <source>Ticks on the last good pose after a bad sample</source>
        <translation>Takte mit der letzten guten Lage nach einem schlechten Messwert</translation>
    </message>
    <message>
        <source>Ticks without usable device input, hence without force</source>
        <translation>Takte ohne brauchbare Geräteeingabe, daher ohne Kraft</translation>
    </message>
    <message>
        <source>Ticks for which the device had nothing new</source>
        <translation>Takte, zu denen das Gerät nichts Neues hatte</translation>
    </message>
    <message>
        <source>Ticks without force because a computed one was not finite</source>
        <translation>Takte ohne Kraft, weil eine berechnete nicht endlich war</translation>
    </message>
    <message>
        <source>Ticks at the limit of force or torque</source>
        <translation>Takte an der Grenze von Kraft oder Drehmoment</translation>
    </message>
    <message>
        <source>Ticks at the limit of rising force</source>
        <translation>Takte an der Grenze des Kraftanstiegs</translation>
    </message>
    <message>
        <source>Ticks in which the passivity controller acted</source>
        <translation>Takte, in denen der Passivitätsregler eingriff</translation>
    </message>
    <message>
        <source>Ticks whose work went on in the next one: the proxy lags</source>
        <translation>Takte, deren Arbeit im nächsten weiterging: der Proxy bleibt zurück</translation>
    </message>
    <message>
        <source>Followed share of the line</source>
        <translation>Abgefahrener Anteil der Linie</translation>
    </message>
    <message>
        <source>Deviation from the line</source>
        <translation>Abweichung von der Linie</translation>
    </message>
    <message>
        <source>Largest deviation from the line</source>
        <translation>Größte Abweichung von der Linie</translation>
    </message>
    <message>
        <source>Force while following</source>
        <translation>Kraft beim Abfahren</translation>
    </message>
    <message>
        <source>Deviation from the asked force</source>
        <translation>Abweichung von der verlangten Kraft</translation>
    </message>
    <message>
        <source>Stimuli of the secondary task</source>
        <translation>Reize der Nebenaufgabe</translation>
    </message>
    <message>
        <source>Share of stimuli that were answered</source>
        <translation>Anteil der beantworteten Reize</translation>
    </message>
    <message>
        <source>Mean response time of the secondary task</source>
        <translation>Mittlere Reaktionszeit der Nebenaufgabe</translation>
    </message>
    <message>
        <source>Presses that answer no stimulus</source>
        <translation>Tastendrücke, die keinen Reiz beantworten</translation>
    </message>
    <message>
        <source>Interval with the comparison</source>
        <translation>Intervall mit dem Vergleich</translation>
    </message>
    <message>
        <source>Interval that was named</source>
        <translation>Genanntes Intervall</translation>
    </message>
    <message>
        <source>The comparison was named</source>
        <translation>Der Vergleich wurde genannt</translation>
    </message>
    <message>
        <source>Response time</source>
        <translation>Antwortzeit</translation>
    </message>
    <message>
        <source>Time in the passage</source>
        <translation>Zeit im Durchlass</translation>
    </message>
    <message>
        <source>Path in the passage</source>
        <translation>Weg im Durchlass</translation>
    </message>
    <message>
        <source>Contact time in the passage</source>
        <translation>Dauer des Kontakts im Durchlass</translation>
    </message>
    <message>
        <source>Peak force in the passage</source>
        <translation>Größte Kraft im Durchlass</translation>
    </message>
    <message>
        <source>Entries into the passage</source>
        <translation>Eintritte in den Durchlass</translation>
    </message>
    <message>
        <source>Position error at the confirmation</source>
        <translation>Lagefehler bei der Bestätigung</translation>
    </message>
    <message>
        <source>Angle error at the confirmation</source>
        <translation>Winkelfehler bei der Bestätigung</translation>
    </message>
    <message>
        <source>Steps done</source>
        <translation>Erledigte Schritte</translation>
    </message>
    <message>
        <source>Errors of order</source>
        <translation>Fehler in der Reihenfolge</translation>
    </message>
    <message>
        <source>Parts let go elsewhere</source>
        <translation>Anderswo abgelegte Teile</translation>
    </message>
    <message>
        <source>Parts taken again</source>
        <translation>Erneut gegriffene Teile</translation>
    </message>
    <message>
        <source>Steps taken back</source>
        <translation>Zurückgenommene Schritte</translation>
    </message>
    <message>
        <source>Hints</source>
        <translation>Hinweise</translation>
    </message>
    <message>
        <source>Way of the parts over free paths</source>
        <translation>Weg der Teile im Verhältnis zu freien Pfaden</translation>
    </message>
</context>
<context>
    <name>participant</name>
    <message>
        <source>Keys: arrows and page up, down: move · W A S D Q E: turn · with Shift: slowly · Esc: stop</source>
        <translation>Tasten: Pfeile und Bild auf, ab: bewegen · W A S D Q E: drehen · mit Umschalt: langsam · Esc: Stopp</translation>
    </message>
    <message>
        <source>Your consent</source>
        <translation>Ihre Einwilligung</translation>
    </message>
    <message>
        <source>I agree</source>
        <translation>Ich stimme zu</translation>
    </message>
    <message>
        <source>I do not agree</source>
        <translation>Ich stimme nicht zu</translation>
    </message>
    <message>
        <source>%1 to %2</source>
        <translation>%1 bis %2</translation>
    </message>
    <message>
        <source>Which of the two mattered more?</source>
        <translation>Was von beidem war wichtiger?</translation>
    </message>
    <message>
        <source>Please enter a number.</source>
        <translation>Bitte geben Sie eine Zahl ein.</translation>
    </message>
    <message>
        <source>Please enter a number from %1 to %2.</source>
        <translation>Bitte geben Sie eine Zahl von %1 bis %2 ein.</translation>
    </message>
    <message>
        <source>Please decide first.</source>
        <translation>Bitte entscheiden Sie sich zuerst.</translation>
    </message>
    <message>
        <source>Not answered yet: %1. Going on once more leaves that out.</source>
        <translation>Noch nicht beantwortet: %1. Noch einmal „Weiter“ lässt das aus.</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>Zurück</translation>
    </message>
    <message>
        <source>Done</source>
        <translation>Fertig</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>Weiter</translation>
    </message>
    <message>
        <source>Page %1 of %2</source>
        <translation>Seite %1 von %2</translation>
    </message>
    <message>
        <source>Put the part into the opening</source>
        <translation>Stecken Sie das Teil in die Öffnung</translation>
    </message>
    <message>
        <source>Move the part through the passage</source>
        <translation>Führen Sie das Teil durch die Engstelle</translation>
    </message>
    <message>
        <source>Follow the line</source>
        <translation>Folgen Sie der Linie</translation>
    </message>
    <message>
        <source>Bring the part to its place</source>
        <translation>Bringen Sie das Teil an seinen Platz</translation>
    </message>
    <message>
        <source>Feel the part: first</source>
        <translation>Ertasten Sie das Teil: zum ersten</translation>
    </message>
    <message>
        <source>Feel the part: second</source>
        <translation>Ertasten Sie das Teil: zum zweiten</translation>
    </message>
    <message>
        <source>Welcome</source>
        <translation>Willkommen</translation>
    </message>
    <message>
        <source>One moment</source>
        <translation>Einen Moment</translation>
    </message>
    <message>
        <source>Move to the start</source>
        <translation>Zum Start bewegen</translation>
    </message>
    <message>
        <source>Go</source>
        <translation>Los</translation>
    </message>
    <message>
        <source>Take the real part</source>
        <translation>Nehmen Sie das echte Teil</translation>
    </message>
    <message>
        <source>Leave the device at rest</source>
        <translation>Lassen Sie das Gerät ruhen</translation>
    </message>
    <message>
        <source>Rest</source>
        <translation>Ruhen Sie sich aus</translation>
    </message>
    <message>
        <source>Another device</source>
        <translation>Ein anderes Gerät</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Pause</translation>
    </message>
    <message>
        <source>Thank you!</source>
        <translation>Vielen Dank!</translation>
    </message>
    <message>
        <source>It begins in a moment.</source>
        <translation>Gleich geht es los.</translation>
    </message>
    <message>
        <source>Hold the part still where its pale image is.</source>
        <translation>Halten Sie das Teil ruhig dort, wo sein blasses Bild ist.</translation>
    </message>
    <message>
        <source>Put the parts together</source>
        <translation>Setzen Sie die Teile zusammen</translation>
    </message>
    <message>
        <source>Hold the gripper still where its pale image is.</source>
        <translation>Halten Sie den Greifer ruhig dort, wo sein blasses Bild ist.</translation>
    </message>
    <message>
        <source>Drag: move · Shift: depth · Ctrl: turn · space bar: grip, again: let go</source>
        <translation>Ziehen: bewegen · Umschalt: Tiefe · Strg: drehen · Leertaste: greifen, noch einmal: loslassen</translation>
    </message>
    <message>
        <source>Drag: move · Shift: depth · Ctrl: turn · hold the space bar: grip, release: let go</source>
        <translation>Ziehen: bewegen · Umschalt: Tiefe · Strg: drehen · Leertaste halten: greifen, lösen: loslassen</translation>
    </message>
    <message>
        <source> · backspace: take the last step back</source>
        <translation> · Rücktaste: letzten Schritt zurücknehmen</translation>
    </message>
    <message>
        <source>Steps: %1 of %2</source>
        <translation>Schritte: %1 von %2</translation>
    </message>
    <message>
        <source>Drag: move · Shift: depth · Ctrl: turn · space bar: it is there</source>
        <translation>Ziehen: bewegen · Umschalt: Tiefe · Strg: drehen · Leertaste: es ist da</translation>
    </message>
    <message>
        <source>Drag: move · wheel or Shift + drag: depth · right button or Ctrl + drag: turn</source>
        <translation>Ziehen: bewegen · Rad oder Umschalt + Ziehen: Tiefe · rechte Taste oder Strg + Ziehen: drehen</translation>
    </message>
    <message>
        <source>The experimenter stops the time.</source>
        <translation>Die Versuchsleitung stoppt die Zeit.</translation>
    </message>
    <message>
        <source>The experimenter says when to begin.</source>
        <translation>Die Versuchsleitung sagt, wann es losgeht.</translation>
    </message>
    <message>
        <source>Answer the signals only.</source>
        <translation>Antworten Sie nur auf die Signale.</translation>
    </message>
    <message>
        <source>Go on when you are ready.</source>
        <translation>Machen Sie weiter, wenn Sie bereit sind.</translation>
    </message>
    <message>
        <source>It goes on in a moment.</source>
        <translation>Gleich geht es weiter.</translation>
    </message>
    <message>
        <source>The experimenter sets it up. Please keep your hands away from it.</source>
        <translation>Die Versuchsleitung richtet es ein. Bitte halten Sie die Hände davon fern.</translation>
    </message>
    <message>
        <source>You may let go. It goes on when the experimenter says so.</source>
        <translation>Sie dürfen loslassen. Es geht weiter, wenn die Versuchsleitung es sagt.</translation>
    </message>
    <message>
        <source>That was all. Please tell the experimenter.</source>
        <translation>Das war alles. Bitte sagen Sie der Versuchsleitung Bescheid.</translation>
    </message>
    <message>
        <source>Not this time</source>
        <translation>Diesmal nicht</translation>
    </message>
    <message>
        <source>Understood</source>
        <translation>Verstanden</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>Weiter</translation>
    </message>
    <message>
        <source>The first</source>
        <translation>Das erste</translation>
    </message>
    <message>
        <source>The second</source>
        <translation>Das zweite</translation>
    </message>
    <message>
        <source>Success</source>
        <translation>Geschafft</translation>
    </message>
</context>
<context>
    <name>participants</name>
    <message>
        <source>%1 is enrolled.</source>
        <translation>%1 ist aufgenommen.</translation>
    </message>
    <message>
        <source>%1: the decision on “%2” is stored.</source>
        <translation>%1: Die Entscheidung zu „%2“ ist gespeichert.</translation>
    </message>
    <message>
        <source>%1 takes part again.</source>
        <translation>%1 nimmt wieder teil.</translation>
    </message>
    <message>
        <source>%1 has left the study.</source>
        <translation>%1 hat die Studie verlassen.</translation>
    </message>
    <message>
        <source>Delete these copies too: %1</source>
        <translation>Löschen Sie auch diese Kopien: %1</translation>
    </message>
    <message>
        <source>Conditions</source>
        <translation>Bedingungen</translation>
    </message>
    <message>
        <source>Conditions within %1</source>
        <translation>Bedingungen innerhalb von %1</translation>
    </message>
    <message>
        <source>Levels of %1</source>
        <translation>Stufen von %1</translation>
    </message>
    <message>
        <source>Assignment of %1</source>
        <translation>Zuordnung von %1</translation>
    </message>
    <message>
        <source>%1 (%2 rows): each pair %3 times</source>
        <translation>%1 (%2 Zeilen): jedes Paar %3-mal</translation>
    </message>
    <message>
        <source>%1 (%2 rows): each position %3 times, each neighbour %4 times</source>
        <translation>%1 (%2 Zeilen): jede Position %3-mal, jede Nachbarschaft %4-mal</translation>
    </message>
    <message>
        <source>balanced</source>
        <translation>ausgewogen</translation>
    </message>
    <message>
        <source>not balanced yet</source>
        <translation>noch nicht ausgewogen</translation>
    </message>
    <message>
        <source>person</source>
        <translation>Person</translation>
    </message>
    <message>
        <source>pilot</source>
        <translation>Pilot</translation>
    </message>
    <message>
        <source>simulated</source>
        <translation>simuliert</translation>
    </message>
    <message>
        <source>takes part</source>
        <translation>nimmt teil</translation>
    </message>
    <message>
        <source>withdrawn</source>
        <translation>zurückgezogen</translation>
    </message>
    <message>
        <source>withdrawn with data</source>
        <translation>mit Daten zurückgezogen</translation>
    </message>
    <message>
        <source>excluded</source>
        <translation>ausgeschlossen</translation>
    </message>
    <message>
        <source>not asked yet</source>
        <translation>noch nicht gefragt</translation>
    </message>
    <message>
        <source>decided on an earlier text</source>
        <translation>über früheren Text entschieden</translation>
    </message>
    <message>
        <source>agreed</source>
        <translation>zugestimmt</translation>
    </message>
    <message>
        <source>declined</source>
        <translation>abgelehnt</translation>
    </message>
    <message>
        <source>open</source>
        <translation>offen</translation>
    </message>
    <message>
        <source>complete</source>
        <translation>vollständig</translation>
    </message>
    <message>
        <source>interrupted</source>
        <translation>unterbrochen</translation>
    </message>
    <message>
        <source>interrupted by a crash</source>
        <translation>durch Absturz unterbrochen</translation>
    </message>
    <message>
        <source>%1&apos;s session of %2 was cut off after its trials.</source>
        <translation>Die Sitzung von %1 vom %2 brach nach ihren Durchgängen ab.</translation>
    </message>
    <message>
        <source>%1&apos;s session of %2 was cut off in a questionnaire, after %3 of %4 trials.</source>
        <translation>Die Sitzung von %1 vom %2 brach in einem Fragebogen ab, nach %3 von %4 Durchgängen.</translation>
    </message>
    <message>
        <source>%1&apos;s session of %2 was cut off in trial %3 of %4.</source>
        <translation>Die Sitzung von %1 vom %2 brach in Durchgang %3 von %4 ab.</translation>
    </message>
    <message>
        <source>A session is running.</source>
        <translation>Eine Sitzung läuft.</translation>
    </message>
    <message>
        <source>The study has a cue that nothing here can give to a person; only simulated participants can take part.</source>
        <translation>Die Studie hat einen Hinweisreiz, den hier nichts einem Menschen geben kann; nur simulierte Personen können teilnehmen.</translation>
    </message>
    <message>
        <source>They take part no more.</source>
        <translation>Diese Person nimmt nicht mehr teil.</translation>
    </message>
    <message>
        <source>Simulated participants are run from the command line.</source>
        <translation>Simulierte Versuchspersonen laufen über die Befehlszeile.</translation>
    </message>
    <message>
        <source>All their sessions are complete.</source>
        <translation>Alle Sitzungen sind vollständig.</translation>
    </message>
    <message>
        <source>No session was interrupted.</source>
        <translation>Keine Sitzung wurde unterbrochen.</translation>
    </message>
    <message>
        <source>They take part.</source>
        <translation>Diese Person nimmt teil.</translation>
    </message>
    <message>
        <source>They withdrew; only they could take that back.</source>
        <translation>Die Person hat sich zurückgezogen; nur sie könnte das rückgängig machen.</translation>
    </message>
    <message>
        <source>They are out of the study already.</source>
        <translation>Diese Person ist schon ausgeschieden.</translation>
    </message>
    <message>
        <source>Give a reason.</source>
        <translation>Geben Sie einen Grund an.</translation>
    </message>
    <message>
        <source>Type the code to confirm.</source>
        <translation>Tippen Sie zum Bestätigen den Code ein.</translation>
    </message>
    <message>
        <source>A code begins with a capital letter and ends with a digit; capitals, digits, - and _ between.</source>
        <translation>Ein Code beginnt mit einem Großbuchstaben und endet mit einer Ziffer; dazwischen Großbuchstaben, Ziffern, - und _.</translation>
    </message>
    <message>
        <source>Codes of pilots begin with T.</source>
        <translation>Codes von Piloten beginnen mit T.</translation>
    </message>
    <message>
        <source>Codes of persons begin with P.</source>
        <translation>Codes von Personen beginnen mit P.</translation>
    </message>
    <message>
        <source>This code is enrolled already.</source>
        <translation>Dieser Code ist schon vergeben.</translation>
    </message>
    <message>
        <source>Somebody who was erased may have had this code.</source>
        <translation>Diesen Code kann jemand gehabt haben, der gelöscht wurde.</translation>
    </message>
    <message>
        <source>%1 sessions, %2 attempts, %3 questionnaires</source>
        <translation>%1 Sitzungen, %2 Versuche, %3 Fragebögen</translation>
    </message>
    <message>
        <source>Takes part no more; consent ends.</source>
        <translation>Nimmt nicht mehr teil; die Einwilligung endet.</translation>
    </message>
    <message>
        <source>Nothing is deleted: %1 stay and count in the analysis.</source>
        <translation>Nichts wird gelöscht: %1 bleiben und zählen in der Auswertung.</translation>
    </message>
    <message>
        <source>Takes part no more; consent ends. Cannot be taken back.</source>
        <translation>Nimmt nicht mehr teil; die Einwilligung endet. Lässt sich nicht zurücknehmen.</translation>
    </message>
    <message>
        <source>Takes part no more. Can be taken back.</source>
        <translation>Nimmt nicht mehr teil. Lässt sich zurücknehmen.</translation>
    </message>
    <message>
        <source>Nothing is deleted: %1 stay and count nowhere.</source>
        <translation>Nichts wird gelöscht: %1 bleiben und zählen nirgends.</translation>
    </message>
    <message>
        <source>Deleted for good: %1, every recorded tick, every consent and note of %2.</source>
        <translation>Endgültig gelöscht: %1, jeder aufgezeichnete Takt, jede Einwilligung und Notiz von %2.</translation>
    </message>
    <message>
        <source>The audit keeps that somebody was erased, not who.</source>
        <translation>Das Protokoll behält, dass jemand gelöscht wurde, nicht wer.</translation>
    </message>
    <message>
        <source>Exports, and copies elsewhere, are yours to delete.</source>
        <translation>Exporte und Kopien an anderen Orten müssen Sie selbst löschen.</translation>
    </message>
    <message>
        <source>They were erased from the backup too.</source>
        <translation>Auch in der Sicherung gelöscht.</translation>
    </message>
    <message>
        <source>They could not be erased from the backup: %1</source>
        <translation>In der Sicherung nicht gelöscht: %1</translation>
    </message>
    <message>
        <source>Their slot is free for the next participant.</source>
        <translation>Der Platz im Versuchsplan ist für die nächste Person frei.</translation>
    </message>
    <message>
        <source>Group %1, participants: %2</source>
        <translation>Gruppe %1, Versuchspersonen: %2</translation>
    </message>
    <message>
        <source>Even with multiples of %1 participants; %2 are planned.</source>
        <translation>Ausgewogen bei Vielfachen von %1 Versuchspersonen; geplant sind %2.</translation>
    </message>
</context>
<context>
    <name>stages</name>
    <message>
        <source>input guard</source>
        <translation>Eingangswächter</translation>
    </message>
    <message>
        <source>always: a device may lie, stall or vanish</source>
        <translation>immer: Ein Gerät kann lügen, stocken oder verschwinden</translation>
    </message>
    <message>
        <source>energy account</source>
        <translation>Energiekonto</translation>
    </message>
    <message>
        <source>always: what the controller takes in and gives out at the handle is recorded</source>
        <translation>immer: Was der Regler am Griff aufnimmt und abgibt, wird aufgezeichnet</translation>
    </message>
    <message>
        <source>start gate</source>
        <translation>Startschranke</translation>
    </message>
    <message>
        <source>start_gate is set: contact begins when the hand holds the start pose</source>
        <translation>start_gate ist gesetzt: Kontakt beginnt, wenn die Hand die Startpose hält</translation>
    </message>
    <message>
        <source>free hand</source>
        <translation>freie Hand</translation>
    </message>
    <message>
        <source>the scene has no obstacle</source>
        <translation>die Szene hat kein Hindernis</translation>
    </message>
    <message>
        <source>contacts at the hand</source>
        <translation>Kontakte an der Hand</translation>
    </message>
    <message>
        <source>contact.method is penalty: forces come from the overlap at the device&apos;s own pose; contact.two_way: of the held part&apos;s points and of the obstacles&apos; points</source>
        <translation>contact.method ist penalty: Kräfte entstehen aus der Überlappung an der Pose des Geräts; contact.two_way: der Punkte des gehaltenen Teils und der Hindernisse</translation>
    </message>
    <message>
        <source>contact.method is penalty: forces come from the overlap at the device&apos;s own pose</source>
        <translation>contact.method ist penalty: Kräfte entstehen aus der Überlappung an der Pose des Geräts</translation>
    </message>
    <message>
        <source>penalty wrench</source>
        <translation>Penalty-Kraft</translation>
    </message>
    <message>
        <source>turns the overlap into force and torque by contact.variant</source>
        <translation>macht aus der Überlappung Kraft und Moment nach contact.variant</translation>
    </message>
    <message>
        <source>proxy correction</source>
        <translation>Proxy-Korrektur</translation>
    </message>
    <message>
        <source>contact.method is god_object_heuristic: steps #1 and #2, contacts at the last proxy and relief of its overlap; contact.two_way: here and below of the held part&apos;s points and of the obstacles&apos; points</source>
        <translation>contact.method ist god_object_heuristic: Schritte #1 und #2, Kontakte am letzten Proxy und Abbau seiner Überlappung; contact.two_way: hier und unten der Punkte des gehaltenen Teils und der Hindernisse</translation>
    </message>
    <message>
        <source>contact.method is god_object_heuristic: steps #1 and #2, contacts at the last proxy and relief of its overlap</source>
        <translation>contact.method ist god_object_heuristic: Schritte #1 und #2, Kontakte am letzten Proxy und Abbau seiner Überlappung</translation>
    </message>
    <message>
        <source>proxy motion</source>
        <translation>Proxy-Bewegung</translation>
    </message>
    <message>
        <source>steps #3 and #4: the proxy follows the hand as far as the contacts let it</source>
        <translation>Schritte #3 und #4: Der Proxy folgt der Hand, soweit die Kontakte es zulassen</translation>
    </message>
    <message>
        <source>closed-form proxy</source>
        <translation>Proxy in geschlossener Form</translation>
    </message>
    <message>
        <source>contact.method is god_object and all pairs have a closed form: the proxy follows the hand as far as the shapes&apos; faces and edges let it; no distance field, no points</source>
        <translation>contact.method ist god_object, und alle Paare haben eine geschlossene Form: Der Proxy folgt der Hand, so weit Flächen und Kanten der Formen ihn lassen; kein Abstandsfeld, keine Punkte</translation>
    </message>
    <message>
        <source>contact.method is god_object_heuristic and all pairs have a closed form: steps #1 to #4 on the shapes&apos; faces and edges; no distance field, no points</source>
        <translation>contact.method ist god_object_heuristic, und alle Paare haben eine geschlossene Form: Schritte #1 bis #4 auf Flächen und Kanten der Formen; kein Abstandsfeld, keine Punkte</translation>
    </message>
    <message>
        <source>common way</source>
        <translation>gemeinsamer Weg</translation>
    </message>
    <message>
        <source>closed-form common way</source>
        <translation>gemeinsamer Weg in geschlossener Form</translation>
    </message>
    <message>
        <source>parts in different hands move in one tick: their common way is free too</source>
        <translation>Teile in verschiedenen Händen bewegen sich im selben Takt: Auch ihr gemeinsamer Weg ist frei</translation>
    </message>
    <message>
        <source>pushes between hands</source>
        <translation>Druck zwischen Händen</translation>
    </message>
    <message>
        <source>parts in different hands may touch: what pushes them is accounted for</source>
        <translation>Teile in verschiedenen Händen können sich berühren: Was sie drückt, wird verbucht</translation>
    </message>
    <message>
        <source>closed-form filter</source>
        <translation>Filter in geschlossener Form</translation>
    </message>
    <message>
        <source>closed-form record</source>
        <translation>Aufzeichnung in geschlossener Form</translation>
    </message>
    <message>
        <source>closed-form hand depth</source>
        <translation>Tiefe der Hand in geschlossener Form</translation>
    </message>
    <message>
        <source>surface proxy</source>
        <translation>Proxy auf Oberflächen</translation>
    </message>
    <message>
        <source>contact.method is god_object and contact is that of surfaces: the proxy follows the hand as far as no triangles meet; no distance field, no points</source>
        <translation>contact.method ist god_object, und Kontakt ist der von Oberflächen: Der Proxy folgt der Hand, soweit keine Dreiecke sich treffen; kein Abstandsfeld, keine Punkte</translation>
    </message>
    <message>
        <source>contact.method is god_object_heuristic and contact is that of surfaces: the proxy follows the hand as far as no triangles meet; no distance field, no points</source>
        <translation>contact.method ist god_object_heuristic, und Kontakt ist der von Oberflächen: Der Proxy folgt der Hand, soweit keine Dreiecke sich treffen; kein Abstandsfeld, keine Punkte</translation>
    </message>
    <message>
        <source>surface record</source>
        <translation>Aufzeichnung auf Oberflächen</translation>
    </message>
    <message>
        <source>the proven gap and the contacts at the proxy, for the record</source>
        <translation>bewiesener Spalt und Kontakte am Proxy, für die Aufzeichnung</translation>
    </message>
    <message>
        <source>surface hand depth</source>
        <translation>Tiefe der Hand auf Oberflächen</translation>
    </message>
    <message>
        <source>the way from proxy to hand along what holds it is recorded</source>
        <translation>Der Weg vom Proxy zur Hand entlang dem, was ihn hält, wird aufgezeichnet</translation>
    </message>
    <message>
        <source>proxy sweep</source>
        <translation>Proxy-Schwenk</translation>
    </message>
    <message>
        <source>contact.method is god_object: the proxy follows the hand as far as all contacts within reach let it; contact.two_way: of the held part&apos;s points and of the obstacles&apos; points</source>
        <translation>contact.method ist god_object: Der Proxy folgt der Hand, soweit alle Kontakte in Reichweite es zulassen; contact.two_way: der Punkte des gehaltenen Teils und der Hindernisse</translation>
    </message>
    <message>
        <source>contact.method is god_object: the proxy follows the hand as far as all contacts within reach let it</source>
        <translation>contact.method ist god_object: Der Proxy folgt der Hand, soweit alle Kontakte in Reichweite es zulassen</translation>
    </message>
    <message>
        <source>proxy filter</source>
        <translation>Proxy-Filter</translation>
    </message>
    <message>
        <source>contact.proxy_filter_hz is set: a low-pass of the proxy in contact</source>
        <translation>contact.proxy_filter_hz ist gesetzt: Tiefpass des Proxys im Kontakt</translation>
    </message>
    <message>
        <source>proxy record</source>
        <translation>Proxy-Aufzeichnung</translation>
    </message>
    <message>
        <source>contact.budget_nodes with god_object_heuristic: the proxy goes the way of god_object, which can stop in a look and go on in the next tick</source>
        <translation>contact.budget_nodes mit god_object_heuristic: Der Proxy geht den Weg von god_object, der mitten in einer Abfrage anhalten und im nächsten Takt weitergehen kann</translation>
    </message>
    <message>
        <source>overlap and contacts at the proxy, and its lag, for the record</source>
        <translation>Überlappung und Kontakte am Proxy und wie weit er zurückbleibt, für die Aufzeichnung</translation>
    </message>
    <message>
        <source>overlap and contacts at the proxy, for the record</source>
        <translation>Überlappung und Kontakte am Proxy, für die Aufzeichnung</translation>
    </message>
    <message>
        <source>hand depth</source>
        <translation>Handtiefe</translation>
    </message>
    <message>
        <source>the overlap at the device&apos;s pose is measured and recorded</source>
        <translation>die Überlappung an der Pose des Geräts wird gemessen und aufgezeichnet</translation>
    </message>
    <message>
        <source>virtual coupling</source>
        <translation>virtuelle Kopplung</translation>
    </message>
    <message>
        <source>spring and damper between proxy and hand</source>
        <translation>Feder und Dämpfer zwischen Proxy und Hand</translation>
    </message>
    <message>
        <source>contact transients</source>
        <translation>Kontakttransienten</translation>
    </message>
    <message>
        <source>effects.transients is set: a decaying vibration is added at every impact</source>
        <translation>effects.transients ist gesetzt: Bei jedem Aufprall kommt eine abklingende Schwingung hinzu</translation>
    </message>
    <message>
        <source>weight</source>
        <translation>Gewicht</translation>
    </message>
    <message>
        <source>effects.weight is set: the proxy hangs from the hand as far as its weight stretches the coupling</source>
        <translation>effects.weight ist gesetzt: Der Proxy hängt so weit unter der Hand, wie sein Gewicht die Kopplung dehnt</translation>
    </message>
    <message>
        <source>effects.weight is set: no proxy hangs from the hand, which holds the part itself</source>
        <translation>effects.weight ist gesetzt: Kein Proxy hängt an der Hand, die das Teil selbst hält</translation>
    </message>
    <message>
        <source>navigation</source>
        <translation>Navigation</translation>
    </message>
    <message>
        <source>effects.clutch, effects.position_scale or effects.drift is set: the hand&apos;s place in the scene follows them</source>
        <translation>effects.clutch, effects.position_scale oder effects.drift ist gesetzt: Der Ort der Hand in der Szene folgt ihnen</translation>
    </message>
    <message>
        <source>sign of contact</source>
        <translation>Kontaktzeichen</translation>
    </message>
    <message>
        <source>effects.position_scale or effects.drift is set: both wait while parts touch</source>
        <translation>effects.position_scale oder effects.drift ist gesetzt: Beide warten, solange sich Teile berühren</translation>
    </message>
    <message>
        <source>clutched wrench</source>
        <translation>Kraft bei gehaltener Kupplung</translation>
    </message>
    <message>
        <source>effects.clutch is set: the wrench fades while the clutch is held</source>
        <translation>effects.clutch ist gesetzt: Die Kraft klingt ab, solange die Kupplung gehalten wird</translation>
    </message>
    <message>
        <source>weight in the hand</source>
        <translation>Gewicht in der Hand</translation>
    </message>
    <message>
        <source>effects.weight is set: what no contact carries is felt</source>
        <translation>effects.weight ist gesetzt: Was kein Kontakt trägt, wird gefühlt</translation>
    </message>
    <message>
        <source>viscosity</source>
        <translation>Viskosität</translation>
    </message>
    <message>
        <source>effects.viscosity is set: a damper resists the held part&apos;s motion</source>
        <translation>effects.viscosity ist gesetzt: Ein Dämpfer bremst die Bewegung des gehaltenen Teils</translation>
    </message>
    <message>
        <source>guidance</source>
        <translation>Führung</translation>
    </message>
    <message>
        <source>effects.guidance has a share above 0: a guide draws the hand along</source>
        <translation>effects.guidance hat einen Anteil über 0: Eine Führung zieht die Hand mit</translation>
    </message>
    <message>
        <source>snap</source>
        <translation>Einrasten</translation>
    </message>
    <message>
        <source>effects.snap is set: near its place the held part is drawn into it</source>
        <translation>effects.snap ist gesetzt: Nahe seinem Platz wird das gehaltene Teil hineingezogen</translation>
    </message>
    <message>
        <source>inertia</source>
        <translation>Trägheit</translation>
    </message>
    <message>
        <source>effects.inertia is set: the proxy is a mass on the coupling&apos;s spring</source>
        <translation>effects.inertia ist gesetzt: Der Proxy ist eine Masse an der Feder der Kopplung</translation>
    </message>
    <message>
        <source>keeping apart</source>
        <translation>Abstand halten</translation>
    </message>
    <message>
        <source>effects.keep_apart is set: parts in two hands push each other away before they touch</source>
        <translation>effects.keep_apart ist gesetzt: Teile in zwei Händen stoßen einander ab, bevor sie sich berühren</translation>
    </message>
    <message>
        <source>sum of effects</source>
        <translation>Summe der Effekte</translation>
    </message>
    <message>
        <source>an effect adds to the wrench</source>
        <translation>Ein Effekt kommt zu Kraft und Drehmoment hinzu</translation>
    </message>
    <message>
        <source>contact shares</source>
        <translation>Kontaktanteile</translation>
    </message>
    <message>
        <source>always: the energy account is kept for each obstacle too</source>
        <translation>immer: Das Energiekonto wird auch für jedes Hindernis geführt</translation>
    </message>
    <message>
        <source>output delay</source>
        <translation>Ausgangsverzögerung</translation>
    </message>
    <message>
        <source>device.delay_ticks is set</source>
        <translation>device.delay_ticks ist gesetzt</translation>
    </message>
    <message>
        <source>passivity controller</source>
        <translation>Passivitätsregler</translation>
    </message>
    <message>
        <source>effects.passivity_controller is set: a damper takes back energy that was given out</source>
        <translation>effects.passivity_controller ist gesetzt: Ein Dämpfer nimmt abgegebene Energie zurück</translation>
    </message>
    <message>
        <source>no wrench</source>
        <translation>keine Kraft</translation>
    </message>
    <message>
        <source>feedback.kinesthetic is false: contact is computed, nothing is displayed</source>
        <translation>feedback.kinesthetic ist false: Kontakt wird gerechnet, nichts wird dargestellt</translation>
    </message>
    <message>
        <source>output limits</source>
        <translation>Ausgangsgrenzen</translation>
    </message>
    <message>
        <source>always, last: finite, within the device&apos;s limits, rising slowly enough</source>
        <translation>immer, zuletzt: endlich, innerhalb der Grenzen des Geräts, langsam genug steigend</translation>
    </message>
    <message>
        <source>penalty tool</source>
        <translation>Penalty-Werkzeug</translation>
    </message>
    <message>
        <source>contact.coupling is virtual: a tool with mass between the hand&apos;s spring and the contacts&apos; penalty</source>
        <translation>contact.coupling ist virtual: ein Werkzeug mit Masse zwischen der Feder der Hand und dem Penalty der Kontakte</translation>
    </message>
    <message>
        <source>contact.coupling is quasi_static: a tool where the hand&apos;s spring and the contacts&apos; penalty balance</source>
        <translation>contact.coupling ist quasi_static: ein Werkzeug dort, wo die Feder der Hand und der Penalty der Kontakte im Gleichgewicht sind</translation>
    </message>
</context>
<context>
    <name>study</name>
    <message>
        <source>Williams square</source>
        <translation>Williams-Quadrat</translation>
    </message>
    <message>
        <source>all orders</source>
        <translation>alle Reihenfolgen</translation>
    </message>
    <message>
        <source>each pass in random order</source>
        <translation>jeder Durchlauf in zufälliger Reihenfolge</translation>
    </message>
    <message>
        <source>all trials shuffled</source>
        <translation>alle Durchgänge gemischt</translation>
    </message>
    <message>
        <source>as listed</source>
        <translation>wie aufgeführt</translation>
    </message>
    <message>
        <source>staircase</source>
        <translation>Staircase-Verfahren</translation>
    </message>
    <message>
        <source>passes: %1</source>
        <translation>Durchläufe: %1</translation>
    </message>
    <message>
        <source>session %1</source>
        <translation>Sitzung %1</translation>
    </message>
    <message>
        <source>after %1 s of rest</source>
        <translation>nach %1 s Pause</translation>
    </message>
    <message>
        <source>About %1 min a participant with every trial to its time-out and shortest rests; ways to the start, repeats and questionnaires come on top.</source>
        <translation>Etwa %1 min je Person mit jedem Durchgang bis zum Zeitlimit und kürzesten Pausen; Wege zum Start, Wiederholungen und Fragebögen kommen dazu.</translation>
    </message>
    <message>
        <source>This study picks its accuracy by itself when its first session begins: every setting is then measured on this machine and kept here.</source>
        <translation>Diese Studie wählt ihre Genauigkeit selbst, wenn die erste Sitzung beginnt: Jede Einstellung wird dann auf diesem Rechner gemessen und hier aufbewahrt.</translation>
    </message>
    <message>
        <source>Budget %1 µs: %2, tolerance %3 µm, spacing %4 mm – %5 µs, error %6 µm</source>
        <translation>Budget %1 µs: %2, Toleranz %3 µm, Abstand %4 mm – %5 µs, Fehler %6 µm</translation>
    </message>
    <message>
        <source>Fit for studies.</source>
        <translation>Geeignet für Studien.</translation>
    </message>
    <message>
        <source>Good now, but without real-time scheduling another program can spoil it.</source>
        <translation>Jetzt gut, aber ohne Echtzeit-Priorität kann ein anderes Programm stören.</translation>
    </message>
    <message>
        <source>Fit for trying out, not for studies.</source>
        <translation>Geeignet zum Ausprobieren, nicht für Studien.</translation>
    </message>
    <message>
        <source>Not fit: close other programs, grant real-time scheduling, or use another machine.</source>
        <translation>Nicht geeignet: Schließen Sie andere Programme, erlauben Sie Echtzeit-Priorität oder nehmen Sie einen anderen Rechner.</translation>
    </message>
    <message>
        <source>The study has problems.</source>
        <translation>Die Studie hat Fehler.</translation>
    </message>
    <message>
        <source>A session is running.</source>
        <translation>Eine Sitzung läuft.</translation>
    </message>
    <message>
        <source>Measuring …</source>
        <translation>Wird gemessen …</translation>
    </message>
    <message>
        <source>Nothing was measured yet. Measuring lets a simulated hand do a trial of the condition, runs the tick along its way with every method and geometry that the parts can have, and shows what each costs and how true it is. It takes minutes; the window can be used meanwhile.</source>
        <translation>Noch ist nichts gemessen. Die Messung lässt eine simulierte Hand einen Durchgang der Bedingung machen, rechnet den Takt auf ihrem Weg mit jeder Methode und Geometrie, die die Teile haben können, und zeigt, was jede kostet und wie wahr sie ist. Das dauert Minuten; das Fenster kann währenddessen benutzt werden.</translation>
    </message>
</context>
<context>
    <name>words</name>
    <message>
        <source>Trial %1 of %2 is being prepared</source>
        <translation>Durchgang %1 von %2 wird vorbereitet</translation>
    </message>
    <message>
        <source>Trial %1 of %2 waits for the start pose</source>
        <translation>Durchgang %1 von %2 wartet auf die Startlage</translation>
    </message>
    <message>
        <source>Trial %1 of %2 is running</source>
        <translation>Durchgang %1 von %2 läuft</translation>
    </message>
    <message>
        <source>No session</source>
        <translation>Keine Sitzung</translation>
    </message>
    <message>
        <source>Opening the study</source>
        <translation>Die Studie wird geöffnet</translation>
    </message>
    <message>
        <source>Between trials</source>
        <translation>Zwischen Durchgängen</translation>
    </message>
    <message>
        <source>Ready to start</source>
        <translation>Bereit</translation>
    </message>
    <message>
        <source>Paused</source>
        <translation>Angehalten</translation>
    </message>
    <message>
        <source>Emergency stop: motors are off</source>
        <translation>Not-Halt: Motoren sind aus</translation>
    </message>
    <message>
        <source>Session complete</source>
        <translation>Sitzung vollständig</translation>
    </message>
    <message>
        <source>Session ended early</source>
        <translation>Sitzung vorzeitig beendet</translation>
    </message>
    <message>
        <source>The session failed</source>
        <translation>Die Sitzung ist gescheitert</translation>
    </message>
    <message>
        <source>pauses after this trial</source>
        <translation>hält nach diesem Durchgang an</translation>
    </message>
    <message>
        <source>next: trial %1</source>
        <translation>als Nächstes: Durchgang %1</translation>
    </message>
    <message>
        <source>%1 of %2 trials are finished and stored</source>
        <translation>%1 von %2 Durchgängen sind beendet und gespeichert</translation>
    </message>
    <message>
        <source>to come</source>
        <translation>offen</translation>
    </message>
    <message>
        <source>next</source>
        <translation>als Nächstes</translation>
    </message>
    <message>
        <source>running</source>
        <translation>läuft</translation>
    </message>
    <message>
        <source>succeeded</source>
        <translation>gelungen</translation>
    </message>
    <message>
        <source>timed out</source>
        <translation>Zeit abgelaufen</translation>
    </message>
    <message>
        <source>failed</source>
        <translation>misslungen</translation>
    </message>
    <message>
        <source>aborted</source>
        <translation>abgebrochen</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>ausgelassen</translation>
    </message>
    <message>
        <source>to do</source>
        <translation>offen</translation>
    </message>
    <message>
        <source>picked up</source>
        <translation>aufgenommen</translation>
    </message>
    <message>
        <source>carried</source>
        <translation>getragen</translation>
    </message>
    <message>
        <source>near its place</source>
        <translation>nahe am Ziel</translation>
    </message>
    <message>
        <source>in place, held</source>
        <translation>am Ziel, gehalten</translation>
    </message>
    <message>
        <source>done</source>
        <translation>erledigt</translation>
    </message>
    <message>
        <source>does not count</source>
        <translation>zählt nicht</translation>
    </message>
    <message>
        <source>No session is running.</source>
        <translation>Es läuft keine Sitzung.</translation>
    </message>
    <message>
        <source>The session has begun already.</source>
        <translation>Die Sitzung hat schon begonnen.</translation>
    </message>
    <message>
        <source>The session is not paused.</source>
        <translation>Die Sitzung ist nicht angehalten.</translation>
    </message>
    <message>
        <source>No trial has ended yet.</source>
        <translation>Noch ist kein Durchgang beendet.</translation>
    </message>
    <message>
        <source>No trial is left.</source>
        <translation>Es ist kein Durchgang mehr übrig.</translation>
    </message>
    <message>
        <source>No trial is running.</source>
        <translation>Es läuft kein Durchgang.</translation>
    </message>
    <message>
        <source>Not possible now: %1</source>
        <translation>Jetzt nicht möglich: %1</translation>
    </message>
    <message>
        <source>Warning: %1</source>
        <translation>Warnung: %1</translation>
    </message>
    <message>
        <source>The session begins.</source>
        <translation>Die Sitzung beginnt.</translation>
    </message>
    <message>
        <source>The session pauses after the running trial.</source>
        <translation>Die Sitzung hält nach dem laufenden Durchgang an.</translation>
    </message>
    <message>
        <source>The session goes on.</source>
        <translation>Die Sitzung geht weiter.</translation>
    </message>
    <message>
        <source>The trial is repeated.</source>
        <translation>Der Durchgang wird wiederholt.</translation>
    </message>
    <message>
        <source>The trial is left out.</source>
        <translation>Der Durchgang wird ausgelassen.</translation>
    </message>
    <message>
        <source>The attempt does not count.</source>
        <translation>Der Versuch zählt nicht.</translation>
    </message>
    <message>
        <source>One trial back.</source>
        <translation>Einen Durchgang zurück.</translation>
    </message>
    <message>
        <source>The note is stored.</source>
        <translation>Die Notiz ist gespeichert.</translation>
    </message>
    <message>
        <source>The session is ended.</source>
        <translation>Die Sitzung ist beendet.</translation>
    </message>
    <message>
        <source>The trial has succeeded.</source>
        <translation>Der Durchgang ist gelungen.</translation>
    </message>
    <message>
        <source>The trial has failed.</source>
        <translation>Der Durchgang ist misslungen.</translation>
    </message>
    <message>
        <source>Motors are off; the session is paused.</source>
        <translation>Die Motoren sind aus, die Sitzung ist angehalten.</translation>
    </message>
    <message>
        <source>practice</source>
        <translation>Übung</translation>
    </message>
    <message>
        <source>catch</source>
        <translation>Fangversuch</translation>
    </message>
    <message>
        <source>main</source>
        <translation>Haupt</translation>
    </message>
    <message>
        <source>Paused: the participant&apos;s window is closed</source>
        <translation>Angehalten: Das Fenster der Versuchsperson ist zu</translation>
    </message>
    <message>
        <source>Paused: the participant&apos;s picture is lost</source>
        <translation>Angehalten: Das Bild der Versuchsperson ist ausgefallen</translation>
    </message>
    <message>
        <source>The session has not begun.</source>
        <translation>Die Sitzung hat noch nicht begonnen.</translation>
    </message>
    <message>
        <source>The session is paused already.</source>
        <translation>Die Sitzung ist schon angehalten.</translation>
    </message>
    <message>
        <source>The session pauses after this trial already.</source>
        <translation>Die Sitzung hält nach diesem Durchgang schon an.</translation>
    </message>
    <message>
        <source>The trial is repeated already.</source>
        <translation>Der Durchgang wird schon wiederholt.</translation>
    </message>
    <message>
        <source>The trial&apos;s clock has not been started.</source>
        <translation>Die Uhr des Durchgangs läuft noch nicht.</translation>
    </message>
    <message>
        <source>It needs a text.</source>
        <translation>Dazu gehört ein Text.</translation>
    </message>
    <message>
        <source>That is not the newest attempt at a trial of this session.</source>
        <translation>Das ist nicht der letzte Versuch eines Durchgangs dieser Sitzung.</translation>
    </message>
    <message>
        <source>The attempt does not count anyway.</source>
        <translation>Der Versuch zählt ohnehin nicht.</translation>
    </message>
    <message>
        <source>It cannot be stored.</source>
        <translation>Es lässt sich nicht speichern.</translation>
    </message>
    <message>
        <source>The device is gone: plug it in, and look whether its service runs.</source>
        <translation>Das Gerät ist weg: einstecken und nachsehen, ob sein Dienst läuft.</translation>
    </message>
    <message>
        <source>The session is paused.</source>
        <translation>Die Sitzung ist angehalten.</translation>
    </message>
    <message>
        <source>No sound: this computer has no output for it</source>
        <translation>Kein Ton: Dieser Rechner hat keinen Ausgang dafür</translation>
    </message>
    <message>
        <source>Sound: %1, delay %2 ms</source>
        <translation>Ton: %1, Verzögerung %2 ms</translation>
    </message>
    <message>
        <source>models of the parts are built: %1 %</source>
        <translation>Modelle der Teile werden gebaut: %1 %</translation>
    </message>
    <message>
        <source>The participant decides on consent</source>
        <translation>Die Versuchsperson entscheidet über die Einwilligung</translation>
    </message>
    <message>
        <source>The participant reads instructions</source>
        <translation>Die Versuchsperson liest die Anleitung</translation>
    </message>
    <message>
        <source>The participant answers a questionnaire</source>
        <translation>Die Versuchsperson füllt einen Fragebogen aus</translation>
    </message>
    <message>
        <source>The participant rests</source>
        <translation>Die Versuchsperson ruht sich aus</translation>
    </message>
    <message>
        <source>at least %1 s more</source>
        <translation>mindestens noch %1 s</translation>
    </message>
    <message>
        <source>the participant may go on</source>
        <translation>die Versuchsperson darf weitermachen</translation>
    </message>
    <message>
        <source>change to the device %1, then continue</source>
        <translation>auf das Gerät %1 wechseln, dann fortsetzen</translation>
    </message>
    <message>
        <source>Trial %1 of %2 waits for Start</source>
        <translation>Durchgang %1 von %2 wartet auf „Beginnen“</translation>
    </message>
    <message>
        <source>%1 × %2 pixels, %3 samples each, shadows: %4 a second</source>
        <translation>%1 × %2 Pixel, je %3 Abtastungen, Schatten: %4 je Sekunde</translation>
    </message>
    <message>
        <source>%1 × %2 pixels, %3 samples each, no shadows: %4 a second</source>
        <translation>%1 × %2 Pixel, je %3 Abtastungen, ohne Schatten: %4 je Sekunde</translation>
    </message>
    <message>
        <source>waits for the participant&apos;s picture</source>
        <translation>wartet auf das Bild der Versuchsperson</translation>
    </message>
</context>
</TS>
