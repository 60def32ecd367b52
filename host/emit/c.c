/* c.c: a scene as C for the core. */
#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/emit/c_header.h"
#include "host/emit/c_list.h"
#include "host/emit/emit.h"
#include "host/image/image.h"
#include "host/number/decimal.h"

/* === c names ================================================================================== */
/* A scene is a global object in arbitrary programs. Its name must not be that of a built-in function or of C's library,
 * because it would conflict with a declaration, macro or definition. tests/host/test_c_names.c checks the lists. */

/* Keywords, up to C23. */
static const char words_of_c[] =
    "alignas alignof asm auto bool break case char const constexpr continue default do double "
    "else enum extern false float for goto if inline int long nullptr register restrict "
    "return short signed sizeof static static_assert struct switch thread_local true typedef "
    "typeof typeof_unqual union unsigned void volatile while";

/* Words of C++ up to C++20 that C does not have, and built-in functions for coroutines. */
static const char words_of_cpp[] =
    "and and_eq bitand bitor catch char8_t class co_await co_return co_yield compl concept "
    "const_cast consteval constinit coro_destroy coro_done coro_promise coro_resume decltype delete dynamic_cast explicit export friend "
    "mutable namespace new noexcept not not_eq operator or or_eq private protected public "
    "reinterpret_cast requires static_cast std template this throw try typeid typename using "
    "virtual xor xor_eq";

/* Objects and functions of a generated file. The scene is declared last, so local variables may have its name. */
static const char own[] =
    "main accelerations slopes step_matrix one_step advance multi_step observe start_angle start_real "
    "start_input contacts contact_signals contact_forces contact_sets contact_table "
    "contact_target ledger ledger_powers ledger_levels ledger_accounts ledger_inputs waves "
    "wave_sines wave_rates "
    "WH";

/* Predefined macros of GNU dialects, for any target. */
static const char predefined[] =
    "AVR MIPSEB MIPSEL WIN32 WINNT i386 linux mc68000 mips sparc sun unix";

/* Functions of <math.h> and <complex.h>, which have variants for other types. */
static const char maths[] =
    "M_1_PI M_2_PI M_2_SQRTPI M_E M_LN10 M_LN2 M_LOG10E M_LOG2E M_PI M_PI_2 M_PI_4 M_SQRT1_2 "
    "M_SQRT2 acos acosh acospi asin asinh asinpi atan atan2 atan2pi atanh atanpi cabs cacos "
    "cacosh canonicalize carg casin casinh catan catanh cbrt ccos ccosh ceil cexp cimag clog "
    "clog10 compoundn conj copysign cos cosh cospi cpow cproj creal csin csinh csqrt ctan "
    "ctanh drem erf erfc exp exp10 exp10m1 exp2 exp2m1 expm1 fabs fadd fdim fdiv ffma finite "
    "floor fma fmax fmaximum fmaximum_mag fmaximum_mag_num fmaximum_num fmaxmag fmin fminimum "
    "fminimum_mag fminimum_mag_num fminimum_num fminmag fmod fmul frexp fromfp fromfpx fsqrt "
    "fsub gamma gamma_r getpayload hypot ilogb isinf isnan j0 j1 jn ldexp lgamma lgamma_r "
    "llogb llrint llround log log10 log10p1 log1p log2 log2p1 logb logp1 lrint lround modf "
    "nan nearbyint nextafter nextdown nexttoward nextup pow pow10 pown powr quantize "
    "remainder remquo rint rootn round roundeven rsqrt samequantum scalb scalbln scalbn "
    "setpayload setpayloadsig signbit significand sin sincos sinh sinpi sqrt tan tanh tanpi "
    "tgamma totalorder totalordermag trunc ufromfp ufromfpx y0 y1 yn";

static const char types_and_macros[] =
    "BIG_ENDIAN BUFSIZ CHAR_BIT CHAR_MAX CHAR_MIN CLOCKS_PER_SEC DECIMAL_DIG EDOM EILSEQ EOF "
    "ERANGE EXIT_FAILURE EXIT_SUCCESS FD_SETSIZE FILE FILENAME_MAX FOPEN_MAX HUGE_VAL "
    "HUGE_VALF HUGE_VALL I INFINITY LITTLE_ENDIAN LLONG_MAX LLONG_MIN LONG_MAX LONG_MIN "
    "BYTE_ORDER L_tmpnam SIG_ATOMIC_MAX SIG_ATOMIC_MIN MATH_ERREXCEPT MATH_ERRNO MB_CUR_MAX MB_LEN_MAX NAN NFDBITS NULL ONCE_FLAG_INIT "
    "PDP_ENDIAN PTRDIFF_MAX PTRDIFF_MIN RAND_MAX SCHAR_MAX SCHAR_MIN SEEK_CUR SEEK_END "
    "SEEK_SET SHRT_MAX SHRT_MIN SIGABRT SIGFPE SIGILL SIGINT SIGSEGV SIGTERM SIG_DFL SIG_ERR "
    "SIG_IGN SIZE_MAX TIME_UTC TMP_MAX TSS_DTOR_ITERATIONS UCHAR_MAX ULLONG_MAX ULONG_MAX "
    "USHRT_MAX WCHAR_MAX WCHAR_MIN WCONTINUED WEOF WEXITED WINT_MAX WINT_MIN WNOHANG WNOWAIT "
    "WSTOPPED WUNTRACED assert blkcnt_t blksize_t caddr_t char16_t char32_t clock_t clockid_t "
    "complex daddr_t dev_t div_t double_t errno fd_mask fd_set fenv_t fexcept_t float_t "
    "fpos_t fsblkcnt_t fsfilcnt_t fsid_t gid_t id_t imaxdiv_t ino_t intmax_t intptr_t jmp_buf "
    "key_t ldiv_t lldiv_t locale_t loff_t math_errhandling max_align_t mbstate_t memory_order "
    "mode_t nlink_t noreturn off_t offsetof once_flag pid_t ptrdiff_t quad_t register_t "
    "sig_atomic_t sigjmp_buf sigset_t size_t ssize_t stderr stdin stdout suseconds_t time_t "
    "timer_t u_char u_int u_int16_t u_int32_t u_int64_t u_int8_t u_long u_quad_t u_short "
    "uid_t uint uintmax_t uintptr_t ulong unreachable ushort va_copy va_end va_list va_start "
    "wchar_t wctrans_t wctype_t wint_t";

/* Functions in headers, and built-in functions of compilers. */
static const char functions[] =
    "a64l abort abs aligned_alloc alloca arc4random arc4random_buf arc4random_uniform asctime "
    "asctime_r at_quick_exit atexit atof atoi atol atoll bcmp bcopy bsearch btowc bzero "
    "c16rtomb c32rtomb call_once calloc clearenv clearerr clock ctime ctime_r dcgettext "
    "dgettext difftime div drand48 drand48_r ecvt ecvt_r erand48 erand48_r execl execle "
    "execlp execv execve execvp exit explicit_bzero fclose fcvt fcvt_r feclearexcept fegetenv "
    "fegetexceptflag fegetround feholdexcept feof feraiseexcept ferror fesetenv "
    "fesetexceptflag fesetround fetestexcept feupdateenv fflush ffs ffsimax ffsl ffsll fgetc "
    "fgetpos fgets fgetwc fgetws fopen fork fpclassify fprintf fprintf_unlocked fputc "
    "fputc_unlocked fputs fputs_unlocked fputwc fputws fread free free_aligned_sized "
    "free_sized freopen fscanf fseek fsetpos ftell fwide fwprintf fwrite fwrite_unlocked "
    "fwscanf gcvt getc getchar getenv getloadavg getsubopt gettext getwc getwchar gmtime "
    "gmtime_r imaxabs imaxdiv index initstate initstate_r isalnum isalpha isascii isblank "
    "iscanonical iscntrl isdigit iseqsig isfinite isgraph isgreater isgreaterequal isless "
    "islessequal islessgreater islower isnormal isprint ispunct issignaling isspace "
    "issubnormal isunordered isupper iswalnum iswalpha iswblank iswcntrl iswctype iswdigit "
    "iswgraph iswlower iswprint iswpunct iswspace iswupper iswxdigit isxdigit iszero jrand48 "
    "jrand48_r kill_dependency l64a labs lcong48 lcong48_r ldiv llabs lldiv localeconv "
    "localtime localtime_r longjmp lrand48 lrand48_r malloc mblen mbrlen mbrtoc16 mbrtoc32 "
    "mbrtowc mbsinit mbsrtowcs mbstowcs mbtowc memalign memalignment memccpy memchr memcmp "
    "memcpy memmove mempcpy memset memset_explicit mkdtemp mkstemp mkstemps mktemp mktime "
    "mrand48 mrand48_r nanosleep nrand48 nrand48_r on_exit perror posix_memalign printf "
    "printf_unlocked pselect putc putc_unlocked putchar putchar_unlocked putenv puts "
    "puts_unlocked putwc putwchar qecvt qecvt_r qfcvt qfcvt_r qgcvt qsort quick_exit raise "
    "rand rand_r random random_r realloc reallocarray realpath remove rename rewind rindex "
    "rpmatch savectx scanf seed48 seed48_r select setbuf setenv setjmp setlocale setstate "
    "setstate_r setvbuf siglongjmp signal signgam sigsetjmp snprintf sprintf srand srand48 "
    "srand48_r srandom srandom_r sscanf stpcpy stpncpy strcasecmp strcasecmp_l strcat strchr "
    "strcmp strcoll strcoll_l strcpy strcspn strdup strerror strerror_l strerror_r strfmon "
    "strfromd strfromf strfroml strftime strlcat strlcpy strlen strncasecmp strncasecmp_l "
    "strncat strncmp strncpy strndup strnlen strpbrk strrchr strsep strsignal strspn strstr "
    "strtod strtof strtoimax strtok strtok_r strtol strtold strtoll strtoq strtoul strtoull "
    "strtoumax strtouq strxfrm strxfrm_l swprintf swscanf system time timegm timespec_get "
    "timespec_getres tmpfile tmpnam toascii tolower toupper towctrans towlower towupper "
    "ungetc ungetwc unsetenv valloc vfork vfprintf vfscanf vfwprintf vfwscanf vprintf vscanf "
    "vsnprintf vsprintf vsscanf vswprintf vswscanf vwprintf vwscanf wcrtomb wcscat wcschr "
    "wcscmp wcscoll wcscpy wcscspn wcsftime wcslcat wcslcpy wcslen wcsncat wcsncmp wcsncpy "
    "wcspbrk wcsrchr wcsrtombs wcsspn wcsstr wcstod wcstof wcstoimax wcstok wcstol wcstold "
    "wcstoll wcstombs wcstoul wcstoull wcstoumax wcsxfrm wctob wctomb wctrans wctype wmemchr "
    "wmemcmp wmemcpy wmemmove wmemset wprintf wscanf";

static const char families[] =
    "FLT_ DBL_ LDBL_ DEC32_ DEC64_ DEC128_ FE_ LC_ FP_ ATOMIC_ atomic_ memory_order_ mtx_ "
    "cnd_ thrd_ tss_ pthread_ stdc_ ckd_ wh_ WH_ _";

/* Suffixes of a function for other types. */
static const char *const variants[] = {"",     "f",    "l",     "f16",  "f32", "f64", "f128",
                                       "f32x", "f64x", "f128x", "bf16", "d32", "d64", "d128"};

/* The first word of a list separated by spaces, or NULL. */
static const char *next_word(const char *words, size_t *length) {
    words += strspn(words, " ");
    *length = strcspn(words, " ");
    return *length > 0 ? words : NULL;
}

bool emit_is_among(const char *words, const char *text, size_t length) {
    size_t size;
    for (const char *at = words; (at = next_word(at, &size)) != NULL; at += size) {
        if (size == length && strncmp(at, text, size) == 0) {
            return true;
        }
    }
    return false;
}

static bool begins(const char *name, const char *with) {
    return strncmp(name, with, strlen(with)) == 0;
}

static bool ends(const char *name, const char *in) {
    const size_t length = strlen(name);
    const size_t tail = strlen(in);
    return length > tail && strcmp(name + length - tail, in) == 0;
}

/* Is it a function of `maths`, or a variant such as fabsf, fabsl, fabsf64x, lgammaf_r? */
static bool is_maths(const char *name) {
    const size_t whole = strlen(name);
    const size_t length = ends(name, "_r") ? whole - 2 : whole;
    for (size_t i = 0; i < sizeof variants / sizeof variants[0]; i++) {
        const size_t tail = strlen(variants[i]);
        if (length > tail && strncmp(name + length - tail, variants[i], tail) == 0 &&
            emit_is_among(maths, name, length - tail)) {
            return true;
        }
    }
    return false;
}

/* Is it a name of <stdint.h> or <inttypes.h>, such as INT8_C, UINT_LEAST16_MAX, PRIdPTR? */
static bool is_of_integers(const char *name) {
    const bool format = begins(name, "PRI") || begins(name, "SCN");
    const char *upper = name + (name[0] == 'U');
    const char *lower = name + (name[0] == 'u');
    if (begins(lower, "int")) {
        lower += strlen("int");
        lower += begins(lower, "_least")  ? strlen("_least")
                 : begins(lower, "_fast") ? strlen("_fast")
                                          : 0;
        return isdigit((unsigned char)lower[0]) && ends(lower, "_t");
    }
    return (begins(upper, "INT") && (ends(upper, "_MAX") || ends(upper, "_MIN") ||
                                     ends(upper, "_C") || ends(upper, "_WIDTH"))) ||
           (format && name[3] != '\0' && strchr("bBdiouxX", name[3]) != NULL && name[4] != '\0' &&
            strchr("0123456789LFMP", name[4]) != NULL);
}

bool emit_c_name_is_free(const char *name) {
    const size_t length = strlen(name);
    size_t size;
    for (const char *at = families; (at = next_word(at, &size)) != NULL; at += size) {
        if (strncmp(name, at, size) == 0) {
            return false;
        }
    }
    return !emit_is_among(words_of_c, name, length) && !emit_is_among(own, name, length) &&
           !emit_is_among(predefined, name, length) &&
           !emit_is_among(types_and_macros, name, length) &&
           !emit_is_among(functions, name, length) && !is_maths(name) && !is_of_integers(name);
}

bool emit_c_name_is_free_in_cpp(const char *name) {
    return !emit_is_among(words_of_cpp, name, strlen(name));
}

/* === a scene's contacts as C ================================================================== */

#define KIND_TEXT(name, is) [name] = #name,
static const char *const kinds[WH_CONTACT_KIND_COUNT] = {WH_CONTACT_KINDS(KIND_TEXT)};
#undef KIND_TEXT

static void write_bytes(FILE *out, const char *name, const int *number, int count) {
    for (int i = 0; i < count; i++) {
        if (i == 0) {
            fprintf(out, "static const uint8_t %s[%d] = {", name, count);
        }
        fprintf(out, "%s%d%s", i > 0 ? ", " : "", number[i], i + 1 < count ? "" : "};\n");
    }
}

static void write_table(FILE *out, const image *im) {
    fprintf(out, "static const wh_contact contact_table[%d] = {", im->contacts);
    for (int k = 0; k < im->contacts; k++) {
        const wh_contact row = core_contact_row(&im->contact[k]);
        fprintf(out, "%s\n    {%s, %d, %d, %d, %d}", k > 0 ? "," : "", kinds[row.kind],
                row.direction, row.pin, row.first_set, row.sets);
    }
    fprintf(out, "};\n");
    write_bytes(out, "contact_target", im->target, im->set_count);
}

static void c_contacts_write(FILE *out, const image *im) {
    char hex[HEX_SIZE];
    const bool sets = im->list[IMAGE_SETS] != NULL;
    const wh_contact_system system = core_contact_system(im, NULL, NULL);
    c_list_function(out, im->list[IMAGE_SIGNALS], C_PHASES, "contact_signals", true, C_BY_POINTER);
    c_list_function(out, im->list[IMAGE_FORCES], C_PHASES, "contact_forces", true, C_BY_POINTER);
    if (sets) {
        c_list_function(out, im->list[IMAGE_SETS], C_PHASES, "contact_sets", true, C_BY_POINTER);
    }
    write_table(out, im);
    fprintf(
        out,
        "static const wh_contact_system contacts = {\n    .accel = accelerations,\n"
        "    .signals = contact_signals,\n    .forces = contact_forces,\n    .sets = %s,\n"
        "    .contact = contact_table,\n    .target = %s,\n    .ledger = %s,\n    .contacts = %d,\n"
        "    .forced = %d,\n    .kinds = ",
        sets ? "contact_sets" : "NULL", im->set_count > 0 ? "contact_target" : "NULL",
        im->ledger.kept ? "&ledger" : "NULL", system.contacts, system.forced);
    const char *between = "";
    for (unsigned kind = 0; kind < WH_CONTACT_KIND_COUNT; kind++) {
        if ((system.kinds & WH_KIND_BIT(kind)) != 0) {
            fprintf(out, "%sWH_KIND_BIT(%s)", between, kinds[kind]);
            between = " | ";
        }
    }
    fprintf(out,
            "%s,\n    .pinned = %d,\n    .held = %d,\n"
            "    .evaluations = WH_CONTACT_EVALUATIONS(%d, %d, %d),\n"
            "    .method = %s,\n    .compensated = %s,\n"
            "    .angles = %d,\n    .coordinates = %d,\n",
            system.kinds != 0 ? "" : "0", system.pinned, system.held, core_stages(im),
            core_stops(im), system.forced, wh_methods[system.method].name,
            system.compensated ? "true" : "false", system.angles, system.coordinates);
    if (system.driven != 0) {
        fprintf(out, "    .driven = %d,\n", system.driven);
    }
    fputs("};\n\n", out);
    fprintf(out,
            "WH_INLINE wh_status one_step(const wh_scene *scene, wh_state *state) {\n"
            "    (void)scene;\n    return wh_step_contact(&contacts, WH_R(%s), state);\n}\n\n",
            hex_write(im->step_s, hex));
}

/* === a scene's ledger as C ==================================================================== */

static void write_phases(FILE *out, const image *im, const char *angle) {
    fprintf(out,
            "    wh_phase phase[%d];\n    for (int i = 0; i < %d; i++) {\n"
            "        phase[i] = wh_phase_of(%s[i]);\n    }\n",
            im->angles, im->angles, angle);
}

/* `name` must have 13 characters; otherwise, the parameters are not aligned. */
static void write_of_angles(FILE *out, const image *im, const op_list *t, const char *name,
                            const char *result) {
    fprintf(out,
            "static void %s(const void *model, const wh_angle *angle,\n"
            "                          const wh_real *linear, const wh_real *rate,\n"
            "                          const wh_real *input, wh_real *%s) {\n"
            "    (void)model;\n",
            name, result);
    if (c_list_uses_phase(t)) {
        write_phases(out, im, "angle");
    } else {
        c_list_ignore(out, op_list_reads_turns(t), "angle");
    }
    c_list_ignore(out, op_list_has(t, OP_LINEAR), "linear");
    c_list_ignore(out, op_list_has(t, OP_RATE), "rate");
    c_list_ignore(out, op_list_has(t, OP_INPUT), "input");
    c_list_ignore(out, t->results > 0, result);
    c_list_body(out, t, C_PHASES, result);
}

static void c_ledger_write(FILE *out, const image *im) {
    const image_ledger *l = &im->ledger;
    const wh_ledger_form form = core_ledger_form(im, NULL, NULL);
    if (l->turned) {
        write_of_angles(out, im, im->list[IMAGE_POWERS], "ledger_powers", "power");
    } else {
        c_list_function(out, im->list[IMAGE_POWERS], C_PHASES, "ledger_powers", true, C_BY_POINTER);
    }
    write_of_angles(out, im, im->list[IMAGE_LEVELS], "ledger_levels", "level");
    int *account = alloc(l->smooth, sizeof *account);
    for (int i = 0; i < l->smooth; i++) {
        account[i] = l->entry[i].account;
    }
    write_bytes(out, "ledger_accounts", account, l->smooth);
    free(account);
    write_bytes(out, "ledger_inputs", l->input, l->inputs);
    fprintf(out,
            "static const wh_ledger_form ledger = {\n    .%s = ledger_powers,\n"
            "    .levels = ledger_levels,\n    .account = %s,\n    .smooth = %d,\n"
            "    .entries = %d,\n    .accounts = %d,\n    .coordinates = %d,\n"
            "    .angles = %d,\n",
            l->turned ? "turned" : "powers", l->smooth > 0 ? "ledger_accounts" : "NULL",
            form.smooth, form.entries, form.accounts, form.coordinates, form.angles);
    if (form.inputs > 0) {
        fprintf(out, "    .input = ledger_inputs,\n    .inputs = %d,\n", form.inputs);
    }
    if (form.stabilized) {
        fputs("    .stabilized = true,\n", out);
    }
    fputs("};\n\n", out);
}

/* === the file ================================================================================= */

static void write_observer(FILE *out, const image *im) {
    const op_list *t = im->list[IMAGE_OBSERVE];
    fprintf(out, "static void observe(const wh_scene *scene, const wh_state *state, "
                 "wh_real *output) {\n");
    c_list_ignore(out, op_list_has(t, OP_TIME), "scene");
    if (c_list_uses_phase(t)) {
        write_phases(out, im, "state->angle");
    }
    if (op_list_reads_turns(t)) {
        fprintf(out, "    const wh_angle *angle = state->angle;\n");
    }
    if (op_list_has(t, OP_LINEAR)) {
        fprintf(out, "    const wh_real *linear = state->real;\n");
    }
    if (op_list_has(t, OP_RATE)) {
        fprintf(out, "    const wh_real *rate = state->real + %d;\n", im->coordinates - im->angles);
    }
    if (op_list_has(t, OP_INPUT)) {
        fprintf(out, "    const wh_real *input = state->input;\n");
    }
    if (op_list_has(t, OP_ACCEL)) {
        fprintf(out, "    wh_real accel[%d];\n    wh_contact_observe(&contacts, state, accel);\n",
                im->coordinates);
    }
    const bool reads_state = c_list_uses_phase(t) || op_list_reads_turns(t) ||
                             op_list_has(t, OP_LINEAR) || op_list_has(t, OP_RATE) ||
                             op_list_has(t, OP_INPUT) || op_list_has(t, OP_TIME) ||
                             op_list_has(t, OP_ACCEL) || op_list_has(t, OP_NOISE);
    c_list_ignore(out, reads_state, "state");
    c_list_body(out, t, C_PHASES, "output");
}

static void write_reals(FILE *out, const char *name, const double *number, int count) {
    char hex[HEX_SIZE];
    for (int i = 0; i < count; i++) {
        if (i == 0) {
            fprintf(out, "static const wh_real %s[%d] = {", name, count);
        }
        fprintf(out, "%sWH_R(%s)%s", i > 0 ? ", " : "", hex_write(number[i], hex),
                i + 1 < count ? "" : "};\n");
    }
}

static void write_starts(FILE *out, const image *im) {
    char hex[HEX_SIZE];
    if (im->angles > 0) {
        fprintf(out, "static const wh_angle start_angle[%d] = {", im->angles);
        for (int i = 0; i < im->angles; i++) {
            fprintf(out, "%sWH_TURN(%s, INT64_C(%" PRId64 "))", i > 0 ? ", " : "",
                    hex_write(im->start_rad[i], hex), im->start_turns[i]);
        }
        fprintf(out, "};\n");
    }
    double *input = alloc(im->inputs, sizeof *input);
    image_inputs(im, input);
    write_reals(out, "start_real", im->start_real, im->reals);
    write_reals(out, "start_input", input, im->inputs);
    free(input);
    fprintf(out, "\n");
}

/* wh_multi_step() supports neither contacts, nor a ledger, nor inputs with a rate. */
static bool has_multi_step(const image *im) {
    return im->contacts == 0 && !im->ledger.kept && im->drives == 0;
}

static void write_scene(FILE *out, const image *im) {
    char hex[HEX_SIZE];
    /* the scene comes after the functions, because a local variable may have the scene's name */
    c_header_link(out, "scene", im->name, c_header_of_image, im);
    fprintf(out, "const wh_scene %s = {\n    .name = \"%s\",\n    .form = %s,\n    .method = %s,\n",
            im->name, im->name, im->form == WH_SECOND_ORDER ? "WH_SECOND_ORDER" : "WH_FIRST_ORDER",
            wh_methods[im->settings.method].name);
    fprintf(out, "    .angles = %d,\n    .reals = %d,\n    .inputs = %d,\n    .outputs = %d,\n",
            im->angles, im->reals, im->inputs, im->outputs);
    if (im->contacts > 0) {
        fprintf(out, "    .contacts = %d,\n    .held = %d,\n", im->contacts, im->held);
    }
    if (im->drives > 0) {
        fprintf(out, "    .driven = %d,\n", im->drives);
    }
    if (im->ledger.kept) {
        fprintf(out, "    .ledger = &ledger,\n");
    }
    fprintf(out,
            "    .compensated = %s,\n    .step_s = WH_R(%s),\n"
            "    .step = {UINT64_C(%" PRIu64 "), UINT64_C(%" PRIu64 ")},\n"
            "    .steps = UINT64_C(%" PRIu64 "),\n",
            im->settings.compensated ? "true" : "false", hex_write(im->step_s, hex),
            im->step.numerator, im->step.denominator, im->steps);
    fprintf(out, "    .start_angle = %s,\n", im->angles > 0 ? "start_angle" : "NULL");
    fprintf(out, "    .start_real = %s,\n", im->reals > 0 ? "start_real" : "NULL");
    fprintf(out, "    .start_input = %s,\n", im->inputs > 0 ? "start_input" : "NULL");
    fprintf(out, "    .model = NULL,\n    .model_hash = UINT64_C(0x%016" PRIx64 "),\n", im->hash);
    fprintf(
        out,
        "    .advance = advance,\n%s    .observe = %s,\n    .arithmetic = wh_arithmetic,\n};\n",
        has_multi_step(im)
            ? "#if defined(WH_MULTI_STEP) && WH_MULTI_STEP\n    .multi_step = multi_step,\n#endif\n"
            : "",
        im->outputs > 0 ? "observe" : "NULL");
}

static const op_list *moving(const image *im) {
    return im->list[im->list[IMAGE_MATRIX] != NULL ? IMAGE_MATRIX : IMAGE_STEP];
}

static void write_banner(FILE *out, const image *im, const char *file) {
    const op_list_cost cost = op_list_count(moving(im));
    fputs("/* " EMIT_BANNER " from ", out);
    c_comment(out, file);
    fputs(": do not edit.\n *\n", out);
    fprintf(out, " * scene        %s\n * model hash   0x%016" PRIx64 "\n", im->name, im->hash);
    fprintf(
        out,
        im->list[IMAGE_MATRIX] != NULL
            ? " * a whole step as a matrix: %d additions and products"
            : " * a right-hand side: %d additions and products, %d divisions, %d square roots,\n"
              " *                    %d pairs of sine and cosine",
        cost.arithmetic, cost.divisions, cost.roots, cost.waves);
    if (cost.calls > 0) {
        fprintf(out, ", %d functions of core/function.h", cost.calls);
    }
    if (cost.look_ups > 0) {
        fprintf(out, ", %d looked up in tables", cost.look_ups);
    }
    fprintf(out, "\n *\n");
    c_header_names(out, im);
    fprintf(out, " */\n");
}

static void write_includes(FILE *out, const image *im) {
    if (im->ledger.kept) { /* these bounds must precede the core's headers */
        fprintf(out, "#define WH_LEDGER 1\n#define WH_LEDGER_MAX %d\n#define WH_ACCOUNTS_MAX %d\n",
                im->ledger.entries > 0 ? im->ledger.entries : 1, im->ledger.accounts);
    }
    if (im->contacts > 0) {
        fprintf(out,
                "#define WH_CONTACTS_MAX %d\n#define WH_SETS_MAX %d\n"
                "#include \"core/contact.h\"\nstatic const wh_contact_system contacts;\n"
                "#define WH_CONTACTS_OF(model) (&contacts)\n"
                "#include \"core/contact/contact_step.h\"\n",
                im->contacts, im->set_count > 0 ? im->set_count : 1);
    } else if (im->list[IMAGE_MATRIX] != NULL) {
        fputs("#include \"core/step/matrix_step.h\"\n", out);
    } else {
        const char *const with[2][2] = {{"step", "step/ledger_step"},
                                        {"step/stage_turn", "step/stage_turn_ledger"}};
        fprintf(out, "#include \"core/%s.h\"\n", with[image_turns(im)][im->ledger.kept]);
    }
    if (im->drives > 0) {
        fprintf(out, "#include \"core/step/driven.h\"\n");
    }
    if (im->list[IMAGE_STEP]->tables.count > 0) {
        fprintf(out, "#include \"core/step/table.h\"\n");
    }
    if (image_calls(im)) {
        fprintf(out, "#include \"core/function.h\"\n");
    }
    if (op_list_has(im->list[IMAGE_OBSERVE], OP_NOISE)) {
        fprintf(out, "#include \"core/noise.h\"\n");
    }
}

/* Writes one_step() of a scene without contacts. */
static void write_one_step(FILE *out, const image *im) {
    const bool second = im->form == WH_SECOND_ORDER;
    const char *method = wh_methods[im->settings.method].name;
    const char *compensated = im->settings.compensated ? "true" : "false";
    char hex[HEX_SIZE];
    char rest[HEX_SIZE];
    hex_write(im->step_s, hex);
    hex_write(im->step_s - (double)(float)im->step_s, rest);
    const bool turns = image_turns(im);
    fputs(
        "WH_INLINE wh_status one_step(const wh_scene *scene, wh_state *state) {\n    (void)scene;\n",
        out);
    if (im->list[IMAGE_MATRIX] != NULL) {
        fprintf(out,
                "    return wh_step_matrix(NULL, step_matrix, %s, %dU, %dU, %dU,\n"
                "                          WH_TWO_PART(%s, %s), state);\n}\n\n",
                compensated, im->angles, im->reals, core_rates_at(im), hex, rest);
    } else if (im->ledger.kept) {
        fprintf(out,
                "    return wh_%s_ledger(&ledger, NULL, accelerations,%s %s, %s,\n"
                "                          WH_TWO_PART(%s, %s), state);\n}\n\n",
                turns ? "turn" : "step", turns ? " &waves," : "", method, compensated, hex, rest);
    } else {
        fprintf(out,
                "    return wh_%s_%s(NULL, %s,%s %s, %s, %dU, %dU,\n"
                "                          WH_TWO_PART(%s, %s), state);\n}\n\n",
                turns ? "turn" : "step", second ? "second" : "first",
                second ? "accelerations" : "slopes", turns ? " &waves," : "", method, compensated,
                im->angles, second ? im->coordinates : im->reals, hex, rest);
    }
}

static void write_advance(FILE *out, const image *im) {
    fputs("static wh_status advance(const wh_scene *scene, wh_state *state) {\n", out);
    if (im->drives == 0) {
        fputs("    return wh_step_counted(one_step(scene, state), state);\n}\n\n", out);
    } else {
        const char *books = im->ledger.kept ? "&ledger" : "NULL";
        fprintf(out, "    static const wh_driven drive[%d] = {", im->drives);
        for (int i = 0; i < im->drives; i++) {
            const wh_driven d = core_drive(&im->drive[i]);
            fprintf(out, "%s{%d, %d, %d, %d}", i > 0 ? ", " : "", d.input, d.rate, d.value_at,
                    d.rate_at);
        }
        fprintf(out,
                "};\n    wh_driven_kept kept;\n"
                "    wh_driven_begin(drive, %dU, %s, &kept, state);\n"
                "    const wh_status status = one_step(scene, state);\n"
                "    return wh_step_counted(wh_driven_end(drive, %dU, %s, &kept, status, state), "
                "state);\n}\n\n",
                im->drives, books, im->drives, books);
    }
    if (has_multi_step(im)) {
        fprintf(
            out,
            "#if defined(WH_MULTI_STEP) && WH_MULTI_STEP\n"
            "static wh_status multi_step(const wh_scene *scene, wh_state *state, uint32_t steps) {\n"
            "    return wh_multi_step(scene, one_step, %dU, %dU, %s, state, steps);\n"
            "}\n#endif\n\n",
            im->angles, im->reals, im->settings.compensated ? "true" : "false");
    }
}

void emit_c(FILE *out, const image *im, const char *file) {
    const bool second = im->form == WH_SECOND_ORDER;
    const bool turns = image_turns(im);
    const int components = second ? im->coordinates : im->angles + im->reals;
    const int stages = wh_methods[im->settings.method].stages;
    write_banner(out, im, file);
    /* smaller arrays, for fewer than 4 stages, would not reduce gcc's register spills */
    fprintf(out, "#define WH_COORDS %d\n#define WH_STAGES %d\n", components,
            stages > 4 ? stages : 4);
    if (turns) {
        const int waves = op_list_waves(im->list[IMAGE_STEP]);
        fprintf(out, "#define WH_WAVES %d\n", waves > 0 ? waves : 1);
    }
    if (c_list_is_long(moving(im))) {
        fprintf(out, "#define WH_LONG_LIST 1\n");
    } else if (im->contacts == 0 && !im->ledger.kept && !im->settings.compensated) {
        fprintf(out, "#define WH_SMALL_STEP 1\n");
    }
    write_includes(out, im);
    fprintf(out, "\n");
    write_starts(out, im);
    c_list_cells(out, im->list[IMAGE_STEP]);
    if (im->list[IMAGE_MATRIX] != NULL) {
        c_list_function(out, im->list[IMAGE_MATRIX], C_PHASES, "step_matrix", true, "WH_INLINE");
    } else {
        c_list_function(out, im->list[IMAGE_STEP], turns ? C_WAVES : C_PHASES,
                        second ? "accelerations" : "slopes", second,
                        im->contacts > 0 || im->ledger.asked ? C_BY_POINTER : "WH_INLINE_WITH_FPU");
    }
    if (turns) {
        c_list_waves(out, im->list[IMAGE_STEP]);
    }
    if (im->ledger.kept) {
        c_ledger_write(out, im);
    }
    if (im->contacts > 0) {
        c_contacts_write(out, im);
    } else {
        write_one_step(out, im);
    }
    write_advance(out, im);
    if (im->outputs > 0) {
        write_observer(out, im);
    }
    write_scene(out, im);
}
