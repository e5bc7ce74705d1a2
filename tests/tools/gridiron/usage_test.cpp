// The command line: what is refused, with which exit code and words. SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <regex>

#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

TEST(Usage, MistakesExitWithTwoAndSayWhy) {
  // Command lines, words separated by blanks, that fail with the same words.
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"paint"}, "'paint' is not a command\nexpected render, animate, info, "},
      {{"rendr a.ply"}, "'rendr' is not a command; did you mean render?"},
      {{"help machine"}, "'machine' is not a command; did you mean machines?"},
      {{"help render info"}, "'info' is an argument too many; help takes COMMAND"},
      {{"--verson"}, "--verson is not an option of gridiron; did you mean --version?"},
      {{"--fov 30 render a.ply"}, "put it after a command: render, animate, pack or job have it"},
      {{"--quiet"}, "--quiet is not an option of gridiron; put it after a command: render"},
      {{"experiment paper"}, "-o DIR is required"},
      {{"render", "info"}, "INPUT"},
      {{"render a.ply b.ply"}, "'b.ply' is an argument too many; render takes INPUT"},
      {{"render a.ply --zebra"}, "--zebra is not an option of render\nrun 'gridiron help render'"},
      {{"render a.ply --szie 100x100", "render --szie 100x100 a.ply", "render --szie=100x100"},
       "--szie is not an option of render; did you mean --size?"},
      {{"render a.ply -size 100x100"}, "-size is not an option of render; did you mean --size?"},
      {{"render a.ply --eye -1,-2,-3 --upp 0,0,1"}, "--upp is not an option of render; did you mean --up?"},
      {{"render a.ply --width 100"}, "did you mean --macro-width or --tile-width?"},
      {{"info a.ply --fov 30"}, "--fov is not an option of info; render, animate, pack and job have it"},
      {{"render a.ply --configuration bets"}, "'bets' is not one of best|grid|reference|deep; did you mean best?"},
      {{"render a.ply --accuracy extract"}, "did you mean exact?"},
      {{"render a.ply --shading Scenes"}, "did you mean scene?"},
      {{"experiment acuracy -o x"}, "did you mean accuracy?"},
      {{"render a.ply --size 640", "render a.ply --size 0x10"}, "WxH"},
      {{"render a.ply --size 16385x10"}, "16384"},
      {{"render a.ply --eye 1,2", "render a.ply --eye 1,2,nan"}, "x,y,z"},
      {{"render a.ply --fov 180"}, "180"},
      {{"render a.ply --up w"}, "'w' is not x, y, z, -x, -y, -z or x,y,z with three finite numbers"},
      {{"render a.ply --up -w"}, "'-w' is not x, y, z"},
      {{"render a.ply --from above"}, "'above' is not front, back, left, right, top, bottom, iso or AZIMUTH"},
      {{"render a.ply --from botom"}, "from -90 to 90; did you mean bottom?"},
      {{"render a.ply --up zz"}, "; did you mean z"},
      {{"render a.ply --from 0,91"}, "elevation from -90 to 90"},
      {{"render a.ply --from top --eye 1,2,3"}, "--from and --eye: both say where the eye is"},
      {{"render a.ply --cores 0"}, "1 to 1024"},
      {{"render a.ply --threads -1"}, "1 to 256"},
      {{"render a.ply --configuration fastest"}, "best|grid|reference|deep"},
      {{"render a.ply --buffering triple"}, "single|double"},
      {{"render a.ply --accuracy exactly", "info a.ply --accuracy exactly"}, "paper|fast|standard|exact|compact"},
      {{"render a.ply --shading full"}, "none|simple|scene"},
      {{"render a.ply --shading scene", "animate a.ply -o frames --shading scene"},
       "a mesh has no lights and materials"},
      {{"render a.ply --tolerance 0.1", "info a.gri --tolerance 0.1", "pack a.ply --tolerance 0.1 -o b.gri"},
       "applies to text scenes (NFF) only"},
      {{"render a.nff --tolerance 0", "render a.nff --tolerance inf"}, "above 0"},
      {{"render a.nff --accuracy paper", "info a.nff --accuracy paper"}, "--accuracy paper: has no --shading scene"},
      {{"render a.nff --shading scene --packet 16 --configuration reference", "render a.nff --store 128",
        "render a.nff --tile-width 16", "render a.nff --macro-width 7 --configuration grid",
        "info a.nff --packet 16 --configuration grid"},
       "--shading scene"},
      {{"render a.ply --packet 8", "render a.nff --packet 8", "animate a.ply -o x --packet 8", "info a.ply --packet 8",
        "render a.ply --configuration best --packet 8", "info a.ply --configuration best --packet 32"},
       "--packet: configuration best has no grid and no packets; --configuration grid, reference and deep have"},
      {{"render a.ply --lambda 4", "info a.ply --lambda 4", "pack a.ply -o a.gri --lambda 4",
        "pack a.ply -o a.gri --lambda 4 --configuration best"},
       "--lambda: configuration best has no grid"},
      {{"render a.ply --macro-width 4", "info a.ply --macro-width 4", "pack a.ply -o a.gri --macro-width 4"},
       "--macro-width: configuration best has no grid"},
      {{"render a.ply --no-mailbox"}, "--no-mailbox: configuration best has no grid"},
      {{"render a.ply --no-culling"}, "--no-culling: configuration best has no grid"},
      {{"render a.ply --no-subpackets"}, "--no-subpackets: configuration best has no grid"},
      {{"render a.ply --no-empty-skip"}, "--no-empty-skip: configuration best has no grid"},
      {{"render a.ply --accuracy paper --configuration best", "info a.ply --accuracy paper --configuration best",
        "job a.ply -o a.job --base 0 --accuracy paper --configuration best"},
       "--accuracy paper: configuration best has no triangles for it; --configuration reference and grid have"},
      {{"info a.ply --format projection --configuration best",
        "pack a.ply -o a.gri --format projection --configuration best"},
       "--format projection: configuration best has no triangles for it"},
      {{"render a.ply --tile-width 8"},
       "there are tiles 64 pixels wide and no packets; tiles 32 pixels wide and no packets; --configuration grid has"},
      {{"render a.ply --machine fu540 --configuration best"}, "--configuration grid has them, and --mode plain"},
      {{"animate -o frames"}, "FRAMES"},
      {{"render a.ply --lanes 5"}, "4|8|16"},
      {{"render a.ply --store 96"}, "64|128|256|512"},
      {{"render a.ply --store 512", "info a.ply --store 512"}, "cell-ps3 has a local store of 256 KB"},
      {{"render a.ply --tile-width 24"}, "8|16|32|64"},
      {{"render a.ply --store 128 --mode plain"}, "--mode checked and --lanes 4 only"},
      {{"render a.ply --store 64 --tile-width 64 --configuration reference"}, "not built for tiles 64 pixels wide"},
      {{"render a.ply --lanes 1 --configuration grid"}, "is built for --lanes 4"},
      {{"render a.ply --lanes 1 --mode instrumented"}, "--mode instrumented: has 4 lanes only"},
      {{"render a.ply --configuration best --store 128 --mode plain"}, "--mode checked and --lanes 4 only"},
      {{"render a.ply --store 128 --packet 4 --configuration reference",
        "info a.ply --packet 4 --store 128 --configuration reference"},
       "there are tiles 32 pixels wide and packets of 8x8"},
      {{"render a.ply --tile-width 8 --packet 32 --configuration reference"}, "8 pixels wide"},
      {{"render a.ply --packet 64", "info a.ply --packet 64"}, "4|8|16|32"},
      {{"render a.ply --packet 32 --store 64 --configuration grid",
        "info a.ply --packet 32 --store 64 --configuration grid"},
       "16 pixels wide"},
      {{"render a.ply --mode fast"}, "checked|plain|instrumented"},
      {{"render a.ply --completion never"}, "early|late|random"},
      {{"render a.ply --seed 1"}, "--completion random"},
      {{"render a.ply --completion random --seed -1"}, "digits"},
      {{"render a.ply --lambda 0"}, "1e-6"},
      {{"render a.ply --macro-width 9"}, "1 to 8"},
      {{"render a.ply --tile 3"}, "X,Y"},
      {{"render a.ply --mode plain --timeline t.json"}, "--mode plain does not record what cores do"},
      {{"render a.ply --lanes 8 --timeline t.json"}, "--lanes 4 only"},
      {{"render a.ply --repeat 0"}, "a whole number from 1 to 1000"},
      {{"render a.ply --tile 0,0 --timeline t.json"}, "--tile"},
      {{"render a.ply --store 64 --macro-width 8 --configuration reference"}, "width 8"},
      {{"render a.ply -o x.png --report ./x.png"}, "-o x.png and --report ./x.png are the same file"},
      {{"render a.ply --report .//a.ply"}, "--report .//a.ply: is the input 'a.ply'"},
      {{"render a.ply --camera v.camera --report v.camera"}, "--report v.camera: is the input 'v.camera'"},
      {{"render a.ply -o a.jpg"}, "-o a.jpg: the name of a picture must end in .png or .pfm"},
      {{"render a.ply -o a", "render a.ply -o .png"}, "must end in .png or .pfm"},
      {{"render a.ply --depth a.png"}, "--depth a.png: the name must end in .pfm"},
      {{"render a.ply --ids a.exr"}, "--ids a.exr: the name must end in .pfm"},
      {{"render a.ply -o - --depth -"}, "-o - and --depth - are the same file"},
      {{"render a.ply -o - --report /dev/stdout"}, "-o - and --report /dev/stdout are the same file"},
      {{"animate a.ply -o -"}, "a folder cannot be standard output"},
      {{"info a.ply --accuracy exact --format projection"}, "--accuracy exact: reads --format vertices"},
      {{"info a.nff --packet 8 --store 64 --configuration grid"}, "no packets"},
      {{"info a.nff --depth --store 64"}, "--depth: --shading scene has no distances"},
      {{"render a.nff --depth d.pfm --store 64"}, "--depth: --shading scene has no"},
      {{"pack a.ply"}, "gridiron: -o FILE is required\n"},
      {{"animate a.ply"}, "gridiron: -o DIR is required\n"},
      {{"render a.ply --size 8x8 --size 9x9"}, "gridiron: --size is given twice\n"},
      {{"render a.ply -o a.png --output=b.png"}, "gridiron: -o (--output) is given twice\n"},
      {{"experiment effects -o x --size 16x8"}, "effects needs pictures of at least 16x16 pixels"},
      {{"pack a.ply -o a.ply"}, "-o a.ply: is the input 'a.ply'"},
      {{"pack a.ply -o a.gri --format floats"}, "vertices|projection|lattice"},
      {{"machines cell-ps3 cell-2006"}, "cell-2006"},
  };
  const std::pair<Words, const char*> with_empty_words[] = {
      {{"render", "a.ply", "--machine", ""}, "a machine's name or file"},
      {{"render", "a.ply", "-o", ""}, "'' is not a file name"},
      {{"info", ""}, "INPUT: '' is not a file name"},
      {{"animate", "", "-o", "x"}, "FRAMES: '' is not a file name"},
      {{"result", "a.job", ""}, "RESULT: '' is not a file name"},
  };
  const TemporaryFolder folder;
  for (const auto& [lines, words] : cases) {
    for (const std::string& line : lines) {
      std::istringstream stream(line);
      const Words arguments{std::istream_iterator<std::string>(stream), {}};
      expect_failure(folder, arguments, 2, words);
    }
  }
  for (const auto& [arguments, words] : with_empty_words) expect_failure(folder, arguments, 2, words);
}

TEST(Usage, MachinesThatAreNotThereHaveNearOnes) {
  const TemporaryFolder folder("a.machine", "based_on cell-ps\n");
  folder.write("b.machine", "based_on cell-ps3\ncorecount 3\n");
  const auto expect = [&folder](const std::string& machine, const std::string& words) {
    expect_failure(folder, {"render", "a.ply", "--machine", machine}, 1, words);
  };
  expect("cell-2007", "; did you mean cell-2006?; there are cell-ps3, ");
  expect("fu541", "; did you mean fu540?; there are cell-ps3, ");
  expect("abacus", "no built-in machine of that name; there are cell-ps3, ");
  expect("a.machine", "a.machine:1: 'cell-ps' is no built-in machine; did you mean cell-ps3?");
  expect("b.machine", "b.machine:2: unknown key 'corecount'; did you mean core_count?");
}

TEST(Usage, AFileInPlaceOfACommandIsToldHowToBeRendered) {
  const TemporaryFolder folder("a.ply", "ply\n");
  expect_failure(folder, {"a.ply"}, 2, "gridiron render a.ply");
}

TEST(Usage, NothingAskedForIsAnsweredByAnOverview) {
  const TemporaryFolder folder;
  const ProgramResult result = run(folder, {});
  EXPECT_EQ(result.err, "");
  for (const char* word : {"gridiron render ", "gridiron info ", "gridiron help COMMAND", "animate", "experiment"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << word << "\n" << result.out;
  }
  EXPECT_LE(std::ranges::count(result.out, '\n'), 15) << "short enough to be read\n" << result.out;
}

const Words kCommands = {"render", "animate", "info", "pack", "job", "result", "machines", "experiment", "help"};

TEST(Usage, HelpOfACommandIsThatOfItsOption) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program(folder.folder(), {"help"}).out, run_program(folder.folder(), {"--help"}).out);
  for (const std::string& command : kCommands) {
    const ProgramResult help = run_program(folder.folder(), {"help", command});
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_EQ(help.out, run_program(folder.folder(), {command, "--help"}).out);
    EXPECT_NE(run_program(folder.folder(), {}).out.find(command), std::string::npos) << command;
  }
}

// All long options that a text names, with their dashes.
std::set<std::string> options_in(const std::string& text) {
  std::set<std::string> options;
  const std::regex option("--[a-z][a-z-]*");
  for (std::sregex_iterator found(text.begin(), text.end(), option), end; found != end; ++found) {
    options.insert(found->str());
  }
  return options;
}

TEST(Usage, EveryOptionHasItsPlaceInTheReadme) {
  const TemporaryFolder folder;
  std::ifstream file(std::filesystem::path(GRIDIRON_SCENE_FILES).parent_path() / "tools" / "README.md");
  const std::string readme(std::istreambuf_iterator<char>(file), {});
  const std::set<std::string> told = options_in(readme);
  for (const std::string& command : kCommands) {
    const std::set<std::string> options = options_in(run_program(folder.folder(), {"help", command}).out);
    EXPECT_TRUE(options.contains("--help"));
    for (const std::string& option : options) {
      EXPECT_TRUE(told.contains(option)) << command << " " << option << ": tools/README.md does not name it";
    }
    EXPECT_NE(readme.find("\ngridiron " + command), std::string::npos) << command;
    EXPECT_EQ(options.contains("--quiet"), command != "help") << command;
  }
}

TEST(Usage, NamesOfOneFileAreSeenThroughLinks) {
  const TemporaryFolder folder;
  const auto machine = folder.write("my.machine", "based_on cell-ps3\n");
  const auto mesh = folder.write("a.ply", "ply\n");
  std::filesystem::create_symlink("a.ply", folder.folder() / "link.gri");
  std::filesystem::create_symlink("nowhere", folder.folder() / "dangling");
  const Words cases[] = {
      {"pack", "a.ply", "-o", "link.gri"},
      {"render", "link.gri", "--report", mesh.string()},
      {"render", "a.ply", "--machine", "my.machine", "--report", machine.string()},
      {"render", "a.ply", "--report", "dangling", "--timeline", "nowhere"},
  };
  for (const Words& arguments : cases) {
    const ProgramResult result = run_program(folder.folder(), arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    const bool says_so = result.err.find("are the same file") != std::string::npos ||
                         result.err.find("of this command; writing there would destroy it") != std::string::npos;
    EXPECT_TRUE(says_so) << result.err;
    EXPECT_EQ(read_file(machine), "based_on cell-ps3\n");
    EXPECT_EQ(read_file(mesh), "ply\n");
  }
  // A device takes any number of outputs.
  const ProgramResult result =
      run_program(folder.folder(), {"render", "a.ply", "-o", "/dev/null", "--report", "/dev/null"});
  EXPECT_EQ(result.err.find("same file"), std::string::npos) << result.err;
}

TEST(Usage, HelpAndVersionAreAnswers) {
  const TemporaryFolder folder;
  for (const Words& arguments : {Words{"--help"}, {"render", "--help"}, {"info", "-h"}, {"pack", "--help"}}) {
    const ProgramResult result = run_program(folder.folder(), arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments.front();
    EXPECT_NE(result.out.find("--help"), std::string::npos) << arguments.front();
  }
  const ProgramResult version = run(folder, {"--version"});
  EXPECT_EQ(version.out.find("gridiron "), 0u);
}

// One experiment measures this host: there the number of threads is part of what is measured.
TEST(Usage, HelpTellsWhatThreadsChange) {
  const TemporaryFolder folder;
  const std::string render = run_program(folder.folder(), {"render", "--help"}).out;
  EXPECT_NE(render.find("no result depends on it"), std::string::npos) << render;
  const std::string experiment = run_program(folder.folder(), {"experiment", "--help"}).out;
  EXPECT_EQ(experiment.find("no result depends on it"), std::string::npos) << experiment;
  EXPECT_NE(experiment.find("host_*.csv"), std::string::npos) << experiment;
  EXPECT_NE(experiment.find("minutes"), std::string::npos) << experiment;
}

TEST(Usage, MachinesAreListed) {
  const TemporaryFolder folder;
  EXPECT_NE(run_program(folder.folder(), {"machines"}).out.find("cell-ps3-2gb"), std::string::npos);
  const ProgramResult result = run_program(folder.folder(), {"machines", "--json"});
  ASSERT_EQ(result.exit_code, 0);
  const auto document = nlohmann::json::parse(result.out);
  EXPECT_EQ(document["version"], 2);
  const auto& first = document["machines"][0];
  EXPECT_EQ(first["name"], "cell-ps3");
  EXPECT_EQ(first["core_count"], 6) << "the word of machine files";
  EXPECT_EQ(first["clock_hz"], 3.2e9);
  EXPECT_EQ(first["main_memory_bytes"], 256u << 20);
  EXPECT_TRUE(first["work_cycles"]["group_test_standard"].is_number());
}

TEST(Usage, AFullStandardOutputIsAnError) {
  const TemporaryFolder folder;
  std::string command = GRIDIRON_PROGRAM;
  command += " machines > /dev/full 2> /dev/null";
  const int status = std::system(command.c_str());
  EXPECT_NE(status, 0);
}

TEST(Usage, CapitalsInValuesMakeNoDifference) {
  const TemporaryFolder folder;
  folder.write_ply("a.ply", make_box({0, 0, 0}, {1, 2, 3}));
  const auto picture = [&folder](const Words& options) {
    const ProgramResult result =
        run(folder, Words{"render", "a.ply", "-o", "a.png", "--mode", "plain", "--quiet"} + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_file(folder.path("a.png"));
  };
  const std::string expected = picture({"--up", "z", "--size", "16x8", "--from", "left", "--accuracy", "exact"});
  EXPECT_EQ(picture({"--up", "Z", "--size", "16X8", "--from", "LEFT", "--accuracy", "Exact"}), expected);
  EXPECT_NE(picture({"--up", "Y", "--size", "16X8", "--from", "LEFT"}), expected);
}

}  // namespace
}  // namespace gridiron::test
